//! What `strands view` serves.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Stdio};

use strands_scene::Scene;

use crate::common::{command, folder, strands};

/// A running server, ended with the test.
struct Served {
    child: Child,
    address: String,
}

impl Served {
    fn start(scene: &str) -> Self {
        let mut child = command()
            .args(["view", scene, "--no-open", "--port", "0"])
            .stdout(Stdio::piped())
            .spawn()
            .expect("the command starts");
        let mut line = String::new();
        let out = child.stdout.take().expect("standard output");
        BufReader::new(out).read_line(&mut line).expect("the address");
        let address = line.trim().trim_start_matches("http://").trim_end_matches('/').to_owned();
        Self { child, address }
    }

    /// The head and the body of an answer.
    fn get(&self, path: &str) -> (String, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.address).expect("the server listens");
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", self.address)
            .expect("asks");
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).expect("answers");
        let end = answer.windows(4).position(|four| four == b"\r\n\r\n").expect("a head");
        (String::from_utf8_lossy(&answer[..end]).into_owned(), answer[end + 4..].to_vec())
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn page_is_built() -> bool {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web/dist/index.html").exists()
}

#[test]
fn the_page_and_the_scene_are_served_and_nothing_else() {
    if !page_is_built() {
        let run = strands(&["view", "cantilever.toml", "--no-open"]);
        assert_eq!(run.code, 1);
        assert!(run.err.contains("cargo xtask web"), "{}", run.err);
        return;
    }
    let served = Served::start("cantilever.toml");
    assert!(served.address.starts_with("127.0.0.1:"), "only this machine: {}", served.address);
    let (head, body) = served.get("/");
    assert!(head.starts_with("HTTP/1.1 200") && head.contains("Content-Type: text/html"), "{head}");
    assert!(String::from_utf8_lossy(&body).contains("<html"));
    let (head, body) = served.get("/scene.toml");
    assert!(head.starts_with("HTTP/1.1 200"), "{head}");
    assert_eq!(body, std::fs::read(crate::common::scenes().join("cantilever.toml")).expect("the scene"));
    for path in ["/scene.json", "/absent.js", "/../package.json", "/%2e%2e/package.json", "//etc/passwd"] {
        assert!(served.get(path).0.starts_with("HTTP/1.1 404"), "{path}");
    }
}

#[test]
fn a_scene_that_names_a_table_is_served_with_the_table_in_it() {
    if !page_is_built() {
        return;
    }
    let folder = folder("tables");
    std::fs::write(folder.join("points.csv"), "x,y,z\n0,0,0\n0,0.01,0.1\n0,0.04,0.2\n").expect("a table");
    let scene = r#"
        format = 1
        name = "tables"
        [rods.arc]
        stiffness = { bending = [1e-4, 1e-4], torsion = 1e-4, axial = 1e3, shear = [1e3, 1e3] }
        rest = { csv = "points.csv" }
        supports = [{ at = "start", fix = ["position", "orientation"] }]
    "#;
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
    let served = Served::start(&folder.join("scene.toml").display().to_string());
    let text = String::from_utf8(served.get("/scene.toml").1).expect("UTF-8");
    Scene::parse(&text, "scene.toml", None).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn a_scene_that_is_wrong_is_told_before_anything_is_served() {
    let run = strands(&["view", "misspelt.toml", "--no-open"]);
    assert_eq!((run.code, run.out.as_str()), (1, ""));
}
