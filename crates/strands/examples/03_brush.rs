//! A brush of many bristles, their tips stuck to a plate that moves: how hard do they push it, and what does a frame cost?
//!
//! `cargo run --release -p strands --example 03_brush`

use std::time::Instant;

use strands::math::{Pose, Vec3};
use strands::rod::{Kinematics, Material, Order, Profile, RestShape, Rod, RodDescription, Section, Station};
use strands::statics::{Batch, Problem, Settings, Support};

/// How many bristles there are along a side.
const SIDE: usize = 8;

/// A bristle of its own length and bend, its tip held on the plate.
fn bristle(number: usize) -> Result<Problem, Box<dyn std::error::Error>> {
    let nylon = Material::from_poisson(3e9, 0.4, 1140.0)?;
    let section = Section::Circle { radius: 100e-6 };
    let (row, column) = ((number / SIDE) as f64, (number % SIDE) as f64);
    let foot = Vec3::new(2e-3 * row, 2e-3 * column, 0.0);
    let description = RodDescription {
        length: 30e-3 + 0.1e-3 * ((7 * number) % 11) as f64,
        kinematics: Kinematics::Kirchhoff,
        profile: Profile::Stations(vec![Station { s: 0.0, section, material: nylon }]),
        rest: RestShape::Constant(Vec3::new(2.0 * (row - 3.5), 10.0 + column, 0.0)),
        base: Pose { position: foot, ..Pose::IDENTITY },
    };
    let rod = Rod::with_elements(description, 40, &[], Order::Second)?;
    let tip = Pose { position: foot + Vec3::new(0.0, 0.0, 27e-3), ..Pose::IDENTITY };
    Ok(Problem { end: Support::pinned(tip), ..Problem::cantilever(rod) })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let settings = Settings::default();
    let bristles = (0..SIDE * SIDE).map(bristle).collect::<Result<Vec<_>, _>>()?;
    let mut brush = Batch::new(bristles, &settings)?;
    let step = Vec3::new(0.5e-3, 0.0, 0.0);
    for moved in 1..=10 {
        (0..brush.len()).for_each(|bristle| brush.end_mut(bristle).position += step);
        let start = Instant::now();
        let solved = brush.follow(&settings);
        let each = start.elapsed() / brush.len() as u32;
        let mut push = Vec3::ZERO;
        for bristle in 0..brush.len() {
            push -= brush.solution(bristle).end_reaction().force;
        }
        let off = if solved { "" } else { ", not all solved" };
        println!(
            "moved by {:3.1} mm: the plate is pushed by {:5.1} mN sideways and {:5.1} mN up, {each:?} a bristle{off}",
            0.5 * f64::from(moved),
            push.x * 1e3,
            push.z * 1e3
        );
    }
    Ok(())
}
