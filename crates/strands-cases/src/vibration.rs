//! Frequencies of small vibrations, from what a simulation does in one long step.
//!
//! A step of backward Euler's method turns small velocities `v` of what is in equilibrium into `(M + h²K)⁻¹ M v`, where `M` is its inertia and `K` what
//! pulls it back. Its eigenvectors are the modes, its eigenvalues `1/(1 + h²ω²)`: the step itself has no part in what is found. Lanczos' method (Parlett,
//! The Symmetric Eigenvalue Problem, 1998, ch. 13) finds the modes that a push excites, the slowest first.

use strands::assembly::{Assembly, MassMatrix};
use strands::dynamics::{Integrator, Settings, Simulation, SimulationError, Start, State, StepFailure};
use strands::math::Vec6;
use strands::rod::NodeInertia;
use thiserror::Error;

/// So far do frames move in a step, in rad and over the length: what is not linear in it is lost in round-off, and round-off in it.
const AMPLITUDE: f64 = 1e-5;
/// After so many iterations of Newton's method so small a step is solved to round-off.
const ITERATIONS: usize = 3;
/// Eigenvalues are found when a further vector changes them by less than this.
const SETTLED: f64 = 1e-10;
/// A further vector that is as small is round-off: the push excites no more modes.
const EXHAUSTED: f64 = 1e-7;
/// So many vectors at most.
const VECTORS: usize = 80;
/// What keeps more than all but this of its velocity does not vibrate, but moves on.
const MOVES_ON: f64 = 1e-4;
/// Modes of one frequency, such as those of a ring, are one but for round-off.
const ALIKE: f64 = 1e-6;

/// Why no frequency was found.
#[derive(Debug, Error)]
pub enum VibrationError {
    /// The rod cannot be cut into so few elements.
    #[error(transparent)]
    Rod(#[from] strands::rod::RodError),
    /// It cannot move.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A step was not solved.
    #[error(transparent)]
    Step(#[from] StepFailure),
    /// The push excites fewer modes than are known.
    #[error("{found} modes were found, and {wanted} are known")]
    TooFew {
        /// How many are known.
        wanted: usize,
        /// How many were found.
        found: usize,
    },
}

/// An assembly in equilibrium, to be pushed.
pub struct Vibration {
    simulation: Simulation,
    rest: State,
    inertia: Vec<NodeInertia>,
    /// Between which frame and the next one inertia couples, and how much.
    coupling: Vec<(usize, NodeInertia)>,
    time_step: f64,
}

impl Vibration {
    /// An assembly that is in equilibrium in its rest shape, and how long a step of it is, s: about the period of what is looked for.
    ///
    /// # Errors
    /// Where it cannot move.
    pub fn new(assembly: Assembly, time_step: f64) -> Result<Self, VibrationError> {
        let rods = assembly.strands.iter().flat_map(|strand| strand.problem.rod.node_inertia().to_vec());
        let inertia = rods.chain(assembly.bodies.iter().map(|body| body.inertia)).collect();
        let consistent = assembly.strands.iter().enumerate();
        let consistent = consistent.filter(|(_, strand)| strand.mass_matrix == MassMatrix::Consistent);
        let coupling = consistent
            .flat_map(|(rod, strand)| assembly.nodes(rod).zip(strand.problem.rod.coupling_inertia()))
            .collect();
        let settings = Settings {
            integrator: Integrator::ImplicitEuler,
            time_step,
            max_iterations: ITERATIONS,
            bounded: true,
            ..Settings::default()
        };
        let mut simulation = Simulation::new(assembly, settings, Start::Rest)?;
        // After a step without motion it carries what it bears.
        simulation.step()?;
        let rest = simulation.state().clone();
        Ok(Self { simulation, rest, inertia, coupling, time_step })
    }

    /// What becomes of small velocities in a step.
    ///
    /// # Errors
    /// Where the step is not solved.
    pub fn response(&mut self, velocities: &[Vec6]) -> Result<Vec<Vec6>, VibrationError> {
        let size = self.simulation.assembly().size();
        let largest = velocities
            .iter()
            .fold(0.0_f64, |most, v| most.max(v.angular.max_abs()).max(v.linear.max_abs() / size));
        let scale = AMPLITUDE / (self.time_step * largest);
        let [there, back] = [scale, -scale].map(|scale| {
            self.simulation.restore(self.rest.clone())?;
            self.simulation.set_velocities(&velocities.iter().map(|v| *v * scale).collect::<Vec<_>>());
            self.simulation.step()?;
            Ok::<_, VibrationError>(self.simulation.state().velocities.clone())
        });
        Ok(there?.iter().zip(&back?).map(|(a, b)| (*a - *b) * (0.5 / scale)).collect())
    }

    /// Twice the kinetic energy that two velocities share.
    pub fn product(&self, a: &[Vec6], b: &[Vec6]) -> f64 {
        let of = |inertia: &NodeInertia, a: Vec6, b: Vec6| {
            inertia.rotational.scale(a.angular).dot(b.angular) + a.linear.dot(b.linear) * inertia.mass
        };
        let lumped = self.inertia.iter().zip(a.iter().zip(b)).map(|(inertia, (a, b))| of(inertia, *a, *b));
        let less = self.coupling.iter().map(|(i, inertia)| of(inertia, a[i + 1] - a[*i], b[i + 1] - b[*i]));
        lumped.sum::<f64>() - less.sum::<f64>()
    }

    /// The circular frequency of a mode of which a step leaves so much, rad/s; less than nothing, squared, where it grows.
    pub fn square_of_frequency(&self, left: f64) -> f64 {
        (1.0 / left - 1.0) / (self.time_step * self.time_step)
    }

    /// The lowest circular frequencies that a push excites, rad/s, each once, but for what moves on as a rigid body.
    ///
    /// # Errors
    /// Where a step is not solved.
    pub fn frequencies(&mut self, push: &[Vec6], count: usize) -> Result<Vec<f64>, VibrationError> {
        // What is held or stiff does not stay pushed.
        let mut next = self.response(push)?;
        let mut basis: Vec<Vec<Vec6>> = Vec::new();
        let (mut diagonal, mut beside) = (Vec::new(), Vec::<f64>::new());
        let mut found: Vec<f64> = Vec::new();
        let mut size = self.product(&next, &next).sqrt();
        while basis.len() < VECTORS {
            basis.push(next.iter().map(|v| *v * (1.0 / size)).collect());
            let last = &basis[basis.len() - 1].clone();
            next = self.response(last)?;
            diagonal.push(self.product(&next, last));
            // Twice is enough.
            for vector in basis.iter().chain(&basis) {
                let along = self.product(&next, vector);
                next.iter_mut().zip(vector).for_each(|(v, of)| *v -= *of * along);
            }
            let mut values = largest(&diagonal, &beside, 2 * count + 6);
            values.retain(|value| *value < 1.0 - MOVES_ON);
            values.dedup_by(|next, value| (*next / *value - 1.0).abs() < ALIKE);
            values.truncate(count);
            let settled = values.len() == count
                && found.len() == count
                && values.iter().zip(&found).all(|(now, before)| (now / before - 1.0).abs() < SETTLED);
            found = values;
            size = self.product(&next, &next).sqrt();
            if settled || size < EXHAUSTED * diagonal[0] {
                break;
            }
            beside.push(size);
        }
        Ok(found.into_iter().map(|value| self.square_of_frequency(value).sqrt()).collect())
    }
}

/// The largest eigenvalues, all of them between 0 and 1, of the symmetric matrix with these entries on and beside its diagonal, by bisection.
fn largest(diagonal: &[f64], beside: &[f64], count: usize) -> Vec<f64> {
    let above = |x: f64| {
        let (mut above, mut pivot) = (0, 1.0);
        for (i, entry) in diagonal.iter().enumerate() {
            let coupled = i.checked_sub(1).map_or(0.0, |before| beside[before] * beside[before] / pivot);
            pivot = entry - x - coupled;
            if pivot == 0.0 {
                pivot = f64::EPSILON;
            }
            above += usize::from(pivot > 0.0);
        }
        above
    };
    let value = |k: usize| {
        let (mut low, mut high) = (0.0, 1.01);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if above(middle) > k { low = middle } else { high = middle }
        }
        low
    };
    (0..count.min(diagonal.len())).map(value).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn eigenvalues_of_a_chain_are_those_that_are_known() {
        let chain = super::largest(&[0.5; 9], &[0.25; 8], 9);
        for (k, value) in chain.iter().enumerate() {
            let expected = 0.5 + 0.5 * (std::f64::consts::PI * (k + 1) as f64 / 10.0).cos();
            assert!((value - expected).abs() < 1e-12, "{value} {expected}");
        }
    }
}
