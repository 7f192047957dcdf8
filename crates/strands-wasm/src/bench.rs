//! The solver's speed inside the browser, for comparison with the native figures of `strands bench`.

use strands::load::{Frame, NodalLoads, PointLoad};
use strands::math::{Pose, Quat, Vec3, Wrench};
use strands::rod::{
    Kinematics, Material, Order, Profile, RestShape, Rod, RodDescription, RodError, Section, Station,
};
use strands::statics::{Guess, Problem, Settings, SolveReport, Support, Workspace, follow, solve};
use wasm_bindgen::prelude::*;

/// Does `sweeps` sweeps of a suture with that many elements, then `solves` warm searches for an end that moved by 0.3 % of the length and
/// one degree, and gives how many of those converged. The caller holds the watch.
///
/// # Errors
/// Where the rod cannot be built or solved, which its numbers do not allow.
#[wasm_bindgen]
pub fn bench(elements: usize, sweeps: usize, solves: usize) -> Result<usize, String> {
    let (free, tip) = suture(elements).map_err(|error| error.to_string())?;
    let mut workspace = Workspace::default();
    let settings = Settings { tolerance: 1e-10, ..Settings::default() };
    let mut report = SolveReport::default();
    let once = Settings { max_iterations: 0, ..settings };
    for _ in 0..sweeps {
        let mut guess = tip;
        follow(&free, &once, &mut guess, &mut workspace, &mut report);
    }
    let hanging = solve(&free, &settings, None, &mut workspace).map_err(|failure| failure.to_string())?;
    let mut held = Problem { end: Support::clamped(hanging.guess.pose), ..free };
    let mut converged = 0;
    for i in 0..solves {
        let mut guess = hanging.guess;
        let angle = i as f64 * 2.4;
        let (sin, cos) = (angle.sin(), angle.cos());
        let turn = Quat::from_rotation_vector(
            Vec3::new(cos, sin, 0.3).normalized().unwrap_or(Vec3::X) * 1f64.to_radians(),
        );
        held.end.pose = Pose {
            rotation: hanging.guess.pose.rotation * turn.to_matrix(),
            position: hanging.guess.pose.position
                + Vec3::new(sin, cos, -0.5) * (0.003 * held.rod.length() / 1.12),
        };
        converged += usize::from(follow(&held, &settings, &mut guess, &mut workspace, &mut report));
    }
    Ok(converged)
}

/// A suture of 4-0 polypropylene, clamped, a force and a moment that follow its end.
fn suture(elements: usize) -> Result<(Problem, Guess), RodError> {
    let material = Material::from_poisson(1.5e9, 0.4, 910.0)?;
    let description = RodDescription {
        length: 0.1,
        kinematics: Kinematics::Kirchhoff,
        profile: Profile::Stations(vec![Station {
            s: 0.0,
            section: Section::Circle { radius: 75e-6 },
            material,
        }]),
        rest: RestShape::Constant(Vec3::new(0.0, 8.0, 0.0)),
        base: Pose::IDENTITY,
    };
    let rod = Rod::with_elements(description, elements, &[], Order::Second)?;
    let wrench = Wrench::new(Vec3::new(1e-7, 0.0, 2e-7), Vec3::new(3e-6, 2e-6, -1e-6));
    let load = PointLoad { at: 0.1, wrench, frame: Frame::Body };
    let loads = NodalLoads::none(&rod).with_point(&rod, &load)?;
    Ok((Problem { loads, ..Problem::cantilever(rod) }, Guess::new(Pose::IDENTITY, Wrench::ZERO)))
}
