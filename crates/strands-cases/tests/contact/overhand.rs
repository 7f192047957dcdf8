//! Open overhand knots: how hard they are pulled, by how large their loop is.
//!
//! Audoly, Clauvelin and Neukirch (PRL 99:164301, 2007) take a loose knot apart where its loop of radius `R` is much larger than the thread of radius `h`: two straight tails,
//! a circle, and a braid of both strands, of which lengths are of `√(2hR)`. To the lowest order in `ε = √(h/R)` its ends, which may turn about their axis, are pulled by
//! `T h²/EI = ε⁴/2 + μ σ ε³` while it is tightened, with `σ = 0.492`, and are nearer to each other by `2πR` than the thread is long.

use super::set_up::{EULER, Thread, at_rest, framed, free, least_distance};
use super::shapes::overhand;
use core::f64::consts::PI;
use strands::assembly::{Assembly, Member};
use strands::contact::Surfaces;
use strands::dynamics::{Settings, Simulation, Start, State};
use strands::math::{Pose, Vec3};
use strands::rod::Rod;
use strands::statics::{Problem, Support};

const THREAD: Thread = Thread { radius: 1e-3, modulus: 1.27e9, poisson: 0.3, density: 1000.0 };
const SIGMA: f64 = 0.492;

/// A knot that is about in equilibrium.
struct Knot {
    assembly: Assembly,
    state: State,
    /// What its thread's slow motions take, s.
    slow: f64,
}

impl Knot {
    /// Without friction.
    fn of(epsilon: f64) -> Self {
        let h = THREAD.radius;
        let r = h / (epsilon * epsilon);
        // Tails are bent over `√(EI/T)`.
        let tail = 4.0 * 2.0_f64.sqrt() * r;
        let line = overhand(r, tail, h);
        let length = line.length();
        // Elements are shorter where strands meet.
        let (meet, short, long) = (4.0 * (2.0 * h * r).sqrt(), 0.3 * h / epsilon, 0.15 * r);
        let mut pieces = Vec::new();
        let mut begin = 0.0;
        for (end, size) in [
            (tail - meet, long),
            (tail + meet, short),
            (length - tail - meet, long),
            (length - tail + meet, short),
            (length, long),
        ] {
            pieces.push((end, ((end - begin) / size).ceil() as usize));
            begin = end;
        }
        let rod = THREAD.rod(Pose::IDENTITY, &pieces);
        let places: Vec<Vec3> = rod.mesh().nodes().iter().map(|s| line.at(*s)).collect();
        let poses = framed(&places, Vec3::X);
        let rod = THREAD.rod(poses[0], &pieces);
        let [start, end] = [0, rod.elements()].map(|node| Support::pinned(poses[node]));
        let mut assembly: Assembly = Problem { start, end, ..free(rod) }.into();
        assembly.surfaces = Some(Surfaces { friction: 0.0 });
        let mut state = at_rest(&assembly, poses);
        let slow = r * r * (THREAD.density * PI * h * h / THREAD.bending()).sqrt();
        // What is far from equilibrium first: it is bent sharply in the braid.
        for step in [1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5] {
            let settings = Settings { time_step: step * slow, mass_damping: 0.1 / (step * slow), ..EULER };
            let start = Start::State(Box::new(state));
            let mut simulation = Simulation::new(assembly.clone(), settings, start).unwrap();
            for _ in 0..20 {
                simulation.step().unwrap();
            }
            state = simulation.state().clone();
        }
        Self { assembly, state, slow }
    }

    fn rod(&self) -> &Rod {
        &self.assembly.strands[0].problem.rod
    }

    /// `T R²/EI` where it is tightened slowly: the mean while it slides by some of its elements.
    fn pulled(&self, friction: f64) -> f64 {
        const STEPS: usize = 24;
        let (length, elements) = (self.rod().length(), self.rod().elements());
        let settings = Settings { time_step: 0.5 * self.slow, mass_damping: 0.05 / self.slow, ..EULER };
        let mut assembly = self.assembly.clone();
        assembly.surfaces = Some(Surfaces { friction });
        for (end, pose) in [(0, self.state.poses[0]), (elements, self.state.poses[elements])] {
            assembly.support_mut(Member::Node { rod: 0, node: end }).unwrap().pose = pose;
        }
        let start = Start::State(Box::new(State { time: 0.0, ..self.state.clone() }));
        let mut simulation = Simulation::new(assembly, settings, start).unwrap();
        let mut sum = 0.0;
        for step in 0..STEPS {
            let apart = |state: &State| (state.poses[elements].position - state.poses[0].position).norm();
            let radius = (length - apart(simulation.state())) / (2.0 * PI);
            for (node, way) in [(0, -1.0), (elements, 1.0)] {
                let end = simulation.support_mut(Member::Node { rod: 0, node }).unwrap();
                end.pose.position.z += way * 3e-3 * radius;
            }
            simulation.step().unwrap_or_else(|failure| panic!("μ {friction}: {failure}"));
            let [first, last] = [0, elements].map(|node| simulation.reaction(Member::Node { rod: 0, node }));
            let tension = 0.5 * (last.linear - first.linear).norm();
            let radius = (length - apart(simulation.state())) / (2.0 * PI);
            if step >= STEPS / 2 {
                sum += tension * radius * radius / THREAD.bending();
            }
            // Of the braid's elements only those of the other strand are so near.
            let least = least_distance(&[&simulation.state().poses], 8);
            assert!((2.0..2.03).contains(&(least / THREAD.radius)), "μ {friction}, step {step}: {least:e}");
        }
        sum / (STEPS - STEPS / 2) as f64
    }
}

#[test]
fn a_loose_knot_is_pulled_as_audoly_and_others_say() {
    let epsilons = [0.1, 0.05];
    let knots = epsilons.map(Knot::of);
    // Less what is of the next order in ε.
    let limit = |[one, half]: [f64; 2]| 2.0 * half - one;
    let smooth = [0, 1].map(|k| knots[k].pulled(0.0));
    println!("T R²/EI without friction, for 0.5: {smooth:.4?}, so {:.4}", limit(smooth));
    assert!((limit(smooth) / 0.5 - 1.0).abs() < 0.03, "{smooth:?}");
    assert!((smooth[1] / 0.5 - 1.0).abs() < 0.1, "{smooth:?}");
    for friction in [0.1, 0.3] {
        let sigma = [0, 1].map(|k| (knots[k].pulled(friction) - smooth[k]) * epsilons[k] / friction);
        println!("σ at μ {friction}, for {SIGMA}: {sigma:.4?}, so {:.4}", limit(sigma));
        assert!((limit(sigma) / SIGMA - 1.0).abs() < 0.06, "μ {friction}: {sigma:?}");
    }
}
