//! `strands view`: the page, served to this machine alone.

use std::borrow::Cow;
use std::net::{Ipv4Addr, SocketAddrV4};

use tiny_http::{Header, Method, Request, Response, Server};

use crate::args::View;
use crate::source::{self, Source};
use crate::{Failure, page, say, tell};

/// The port where none is asked for. Where it is taken, the system gives a free one.
const USUAL_PORT: u16 = 7878;

/// Serves the page until it is interrupted.
///
/// # Errors
/// Where the page has not been built, the scene cannot be read, or the port is taken.
pub fn run(options: &View) -> Result<(), Failure> {
    if !page::exists() {
        return Err(Failure::bad("the page is not part of this program: `cargo xtask web` builds it"));
    }
    let mut scene = options.scene.as_deref().map(source::read).transpose()?;
    if let Some(scene) = &mut scene {
        // Said here, where there is a terminal, rather than in the page.
        scene.parse()?;
        scene.text = scene.self_contained()?;
    }
    let server = bind(options.port)?;
    let address = server.server_addr().to_ip().map(|address| format!("http://{address}/"));
    let address = address.ok_or_else(|| Failure::bad("the server has no address"))?;
    say(&format!("{address}\nInterrupt with Ctrl-C."))?;
    if !options.no_open && has_screen() && open::that_detached(&address).is_err() {
        tell(&format!("note: no browser could be opened; go to {address}"));
    }
    for request in server.incoming_requests() {
        // A browser that hangs up while it is answered is its own affair.
        let _ = answer(request, scene.as_ref());
    }
    Ok(())
}

fn bind(port: Option<u16>) -> Result<Server, Failure> {
    let at = |port| Server::http(SocketAddrV4::new(Ipv4Addr::LOCALHOST, port));
    match port {
        Some(port) => at(port).map_err(|error| {
            Failure::bad(format!("port {port}: {error}; leave --port away for a free one, or name another"))
        }),
        None => at(USUAL_PORT).or_else(|_| at(0)).map_err(Failure::bad),
    }
}

/// Whether a browser would have a screen to show itself on.
fn has_screen() -> bool {
    cfg!(any(windows, target_os = "macos"))
        || ["DISPLAY", "WAYLAND_DISPLAY"]
            .iter()
            .any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()))
}

fn answer(request: Request, scene: Option<&Source>) -> std::io::Result<()> {
    if !matches!(request.method(), Method::Get | Method::Head) {
        return request.respond(Response::empty(405));
    }
    let path = request.url().split(['?', '#']).next().unwrap_or("/").trim_start_matches('/').to_owned();
    let path = if path.is_empty() { "index.html" } else { path.as_str() };
    let body = match scene {
        Some(scene) if path == scene.served_as() => Some(Cow::Owned(scene.text.clone().into_bytes())),
        _ => page::file(path),
    };
    let Some(body) = body else {
        return request.respond(Response::from_string("not found\n").with_status_code(404));
    };
    let mut response = Response::from_data(body.into_owned());
    // What stands on the page may change with the next build.
    for (name, value) in [("Content-Type", page::media_type(path)), ("Cache-Control", "no-cache")] {
        if let Ok(header) = Header::from_bytes(name, value) {
            response.add_header(header);
        }
    }
    request.respond(response)
}
