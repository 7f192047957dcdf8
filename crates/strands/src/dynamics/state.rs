//! Where an assembly is, and how it moves.

use super::energy::Power;
use super::passages;
use crate::assembly::Assembly;
use crate::contact::{Contact, Passage};
use crate::math::{Pose, Vec3, Vec6, Wrench};

/// An assembly at some time: all that its future depends on beside what is done to it.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// The time, s.
    pub time: f64,
    /// The frames: of the nodes of the rods, rod by rod, and then of the bodies ([`Assembly::nodes`]).
    pub poses: Vec<Pose>,
    /// How they turn, in their own axes, rad/s, and shift in the world, m/s.
    pub velocities: Vec<Vec6>,
    /// Their momenta, angular about their places, world axes, N·m·s and N·s.
    pub momenta: Vec<Wrench>,
    /// The wrench that each element carries through its far node, in that node's frame, where a stage was solved last: rod by rod
    /// ([`Assembly::elements`]).
    pub wrenches: Vec<Wrench>,
    /// What damping and drag have taken out since the start, J: less than nothing where wind has put in more.
    pub dissipated: f64,
    /// What supports, hands and loads that follow have put in since the start, J.
    pub worked: f64,
    /// How fast energy goes these ways, W.
    pub power: Power,
    /// How long the next step may be, s, where errors choose it.
    pub next_step: f64,
    /// What the integrator looks back on.
    pub past: Past,
    /// What touches, where a stage was solved last.
    pub contacts: Vec<Contact>,
    /// What rods pass through.
    pub passages: Vec<Passage>,
}

/// What an integrator looks back on.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Past {
    /// Nothing.
    #[default]
    None,
    /// The step before, for backward differences.
    Before {
        /// The frames.
        poses: Vec<Pose>,
        /// Their momenta.
        momenta: Vec<Wrench>,
    },
    /// The rates now, for methods that begin a step with them.
    Rates {
        /// What acts on each frame: the rates of the momenta.
        momentum: Vec<Wrench>,
        /// The rates of the exponents of viscous elements.
        strain: Vec<Vec6>,
        /// Their weighted means, for the generalised-α method.
        means: Option<Means>,
    },
}

/// The weighted means of rates of the generalised-α method: about as they were `α_f − α_m` of a step ago.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Means {
    /// Of the frames, in the axes of their velocities.
    pub velocity: Vec<Vec6>,
    /// Of the momenta.
    pub momentum: Vec<Wrench>,
    /// Of the exponents of viscous elements.
    pub strain: Vec<Vec6>,
}

impl State {
    /// At rest in some frames.
    pub(super) fn at_rest(assembly: &Assembly, poses: Vec<Pose>, next_step: f64) -> Self {
        let frames = poses.len();
        Self {
            time: 0.0,
            poses,
            velocities: vec![Vec6::ZERO; frames],
            momenta: vec![Wrench::ZERO; frames],
            wrenches: vec![Wrench::ZERO; frames - assembly.bodies.len() - assembly.strands.len()],
            dissipated: 0.0,
            worked: 0.0,
            power: Power::default(),
            next_step,
            past: Past::None,
            contacts: Vec::new(),
            passages: passages::of_eyelets(assembly),
        }
    }

    /// Whether a step can begin from it: all its numbers are finite, and the next step is longer than nothing.
    pub(super) fn can_begin(&self) -> bool {
        let (mut poses, mut sixes) =
            (vec![&self.poses], vec![&self.velocities, &self.momenta, &self.wrenches]);
        match &self.past {
            Past::None => {}
            Past::Before { poses: before, momenta } => {
                poses.push(before);
                sixes.push(momenta);
            }
            Past::Rates { momentum, strain, means } => {
                sixes.extend([momentum, strain]);
                sixes
                    .extend(means.iter().flat_map(|means| [&means.velocity, &means.momentum, &means.strain]));
            }
        }
        let Power { dissipated, worked } = self.power;
        let numbers =
            [self.time, self.dissipated, self.worked, dissipated, worked, self.next_step].into_iter();
        let columns = poses
            .into_iter()
            .flatten()
            .flat_map(|pose| pose.rotation.cols.into_iter().chain([pose.position]));
        let sixes = sixes.into_iter().flatten().flat_map(|six| six.to_array());
        let contacts =
            self.contacts.iter().flat_map(|contact| [contact.point, contact.normal, contact.force]);
        let forces =
            contacts.flat_map(|part| part.to_array()).chain(self.contacts.iter().map(|contact| contact.gap));
        let passages = self.passages.iter().flat_map(|passage| {
            [passage.place, passage.force].into_iter().flat_map(Vec3::to_array).chain([passage.at])
        });
        let numbers = numbers.chain(columns.flat_map(|column| column.to_array()));
        numbers.chain(sixes).chain(forces).chain(passages).all(f64::is_finite) && self.next_step > 0.0
    }

    /// Whether it is of so many frames and elements.
    pub(super) fn fits(&self, [frames, elements]: [usize; 2]) -> bool {
        let past = match &self.past {
            Past::None => true,
            Past::Before { poses, momenta } => poses.len() == frames && momenta.len() == frames,
            Past::Rates { momentum, strain, means } => {
                let fit = |means: &Means| {
                    [means.velocity.len(), means.momentum.len()] == [frames; 2]
                        && means.strain.len() == elements
                };
                momentum.len() == frames && strain.len() == elements && means.as_ref().is_none_or(fit)
            }
        };
        let now = [self.poses.len(), self.velocities.len(), self.momenta.len()];
        past && now == [frames; 3] && self.wrenches.len() == elements
    }
}
