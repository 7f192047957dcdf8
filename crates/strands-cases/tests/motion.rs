//! Rods that move, against what is known of their motion.

use strands::dynamics::{Integrator, Settings, Simulation, Start};
use strands_cases::falling;

#[test]
fn a_straight_rod_that_weight_begins_to_act_on_swings_as_its_modes_do() {
    // 0.2 % are the rod's own, which bends by a twentieth of its length.
    for (time_step, integrator) in
        [(2e-3, Integrator::Sdirk4), (1e-3, Integrator::Sdirk4), (1e-4, Integrator::Bdf2)]
    {
        let settings = Settings { integrator, time_step, ..Settings::default() };
        let mut simulation = Simulation::new(falling::problem(100).unwrap(), settings, Start::Rest).unwrap();
        let (mut sum, mut steps) = (0.0, 0);
        while simulation.state().time < 0.9995 {
            let time = simulation.step().unwrap().time;
            let tip = simulation.state().poses[100].position.x / falling::sag();
            sum += (tip - falling::sunk(time)).powi(2);
            steps += 1;
        }
        let error = (sum / f64::from(steps)).sqrt();
        assert!(error < 5e-3, "{} at {time_step}: {error}", integrator.name());
    }
}
