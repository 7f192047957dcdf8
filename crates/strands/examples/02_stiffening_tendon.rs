//! A law of one's own: a tendon that stiffens as it stretches and bends, as a stored energy.
//!
//! `cargo run --release -p strands --example 02_stiffening_tendon`

use std::sync::Arc;
use strands::load::{Frame, NodalLoads, PointLoad};
use strands::math::{Pose, Strain, Vec3, Wrench};
use strands::rod::{
    Kinematics, Law, Order, Profile, RestShape, Rod, RodDescription, StiffeningEnergy, Stiffness,
    StoredEnergy,
};
use strands::statics::{Problem, Settings, Workspace, solve};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let stiffness = Stiffness { bending: [2e-4, 2e-4], torsion: 1.5e-4, axial: 500.0, shear: [150.0, 150.0] };
    // Doubled at a radius of 20 mm, or a stretch of 4 %.
    let doubling_strain = Strain::new(Vec3::new(50.0, 50.0, 50.0), Vec3::new(0.04, 0.04, 0.04));
    let energy = StiffeningEnergy { stiffness, doubling_strain };
    println!(
        "derivatives agree to {:.1e}",
        energy.check_derivatives(Strain::new(Vec3::X * 20.0, Vec3::Z * 0.02))
    );
    for (name, law) in
        [("linear", Law::Diagonal(stiffness)), ("stiffening", Law::Hyperelastic(Arc::new(energy)))]
    {
        let description = RodDescription {
            length: 0.1,
            kinematics: Kinematics::Cosserat,
            profile: Profile::Given {
                law,
                mass_per_length: 0.02,
                rotational_inertia_per_length: Vec3::ZERO,
                half_extent: [2e-3; 2],
            },
            rest: RestShape::default(),
            base: Pose::IDENTITY,
        };
        let rod = Rod::with_elements(description, 50, &[], Order::Fourth)?;
        for force in [0.05, 0.2, 0.8] {
            let load =
                PointLoad { at: 0.1, wrench: Wrench::new(Vec3::ZERO, Vec3::X * force), frame: Frame::World };
            let loads = NodalLoads::none(&rod).with_point(&rod, &load)?;
            let problem = Problem { loads, ..Problem::cantilever(rod.clone()) };
            let solution = solve(&problem, &Settings::default(), None, &mut Workspace::default())?;
            let tip = solution.poses[50].position;
            println!("{name:>10}, {force:4.2} N: the tip moves {:5.2} mm across", tip.x * 1e3);
        }
    }
    Ok(())
}
