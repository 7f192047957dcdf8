//! The second variation of the energy, eliminated so that nothing stiff enters: how many ways lead down, and which leads down most.
//!
//! An element's stiffness against stretching is thousands of millions of times that of the whole rod against bending, so that round-off in
//! the pivots of the [elimination](super::elimination) can hide the signs that are wanted. Here the change `w` of the wrench that an element
//! carries stays an unknown beside the motions `ξ` of its nodes, each in the node's own frame, in which what is stiff lies along an axis. The
//! element enters by how it yields, `G`, the inverse of the symmetric part of its resistance, which may be singular. It adds, with `T` from the near
//! frame to the far one and `A ξ = ad*(ξ)` times the wrench carried, what is stationary in `w`,
//!
//! ```text
//! 2 w·(ξ_b − T ξ_a) − w·G w + ξ_b·A T ξ_a
//! ```
//!
//! Each element is eliminated with its near node, twelve by twelve and with interchange, which leaves a resistance on its far node. By
//! Sylvester's law the negative pivots are the ways down and one for each direction in which an element yields, or is as good as rigid. Only
//! a support yields, hardly noticeably: a spring there leaves neutral what is.

use super::super::problem::Problem;
use super::{Axes, Hold, Nodal, Record, dead_moment_slope};
use crate::element;
use crate::math::{Ldl, Mat6, Pose, Vec3, Vec6, largest, ldl, lu};
use crate::rod::{Order, Rod};

/// The resistance to a turn, over that to a shift and the length squared, in the measure of a motion.
pub(super) const TURNING: f64 = 0.02;

/// What yields by less than this part of what yields most does not yield.
const RIGID: f64 = 1e-12;

/// The second variation at a state, and its factors against a drag.
#[derive(Clone, Debug, Default)]
pub(crate) struct SecondVariation {
    elements: Vec<Yielding>,
    nodes: Vec<Node>,
    factors: Vec<Ldl<12>>,
    last: Option<Ldl<6>>,
}

/// An element: how it yields, `G`, in how many directions it yields with the wrench, if at all, rather than against it, and how `T` and half of
/// `A T` take the motion of its near node.
#[derive(Clone, Copy, Debug)]
struct Yielding {
    flexibility: Mat6,
    positive: usize,
    to_far: Mat6,
    half_turned: Mat6,
}

/// A node: the resistance of its loads and its hold, and its share of the length, half of that of the elements beside it.
#[derive(Clone, Copy, Debug)]
struct Node {
    resistance: Mat6,
    share: f64,
}

impl SecondVariation {
    /// Takes the second variation where a rod was [linearised](Nodal::linearise), its supports as `stiff` (over `EI/L³`) as that. `None`
    /// where an element's law cannot be solved.
    pub fn take(&mut self, problem: &Problem, nodal: &Nodal, stiff: f64, state: &Record) -> Option<()> {
        let rod = &problem.rod;
        self.elements.clear();
        self.nodes.clear();
        for e in 0..rod.elements() {
            self.elements.push(Yielding::of(rod, e, &nodal.axes, state)?);
        }
        let places = rod.mesh().nodes();
        let last = rod.elements();
        self.nodes.extend((0..=last).map(|i| {
            let beside = places[(i + 1).min(last)] - places[i.saturating_sub(1)];
            Node { resistance: Mat6::ZERO, share: 0.5 * beside / rod.length() }
        }));
        let mut add = |node: usize, resistance: Mat6| {
            let to_fixed = state.poses[node].from_itself().adjoint_matrix();
            let local = to_fixed.transpose().mul(&resistance).mul(&to_fixed);
            let all = &mut self.nodes[node].resistance;
            *all = all.add(&symmetric(&local));
        };
        for (i, load) in nodal.loads.iter().enumerate().filter(|(_, load)| load.linear != Vec3::ZERO) {
            add(i, dead_moment_slope(load.linear).scaled(-1.0));
        }
        for (node, slope) in &nodal.load_slopes {
            add(*node, Mat6::from_rows(slope).scaled(-1.0));
        }
        for hold in &nodal.holds {
            add(hold.node, hold.resistance(stiff)?);
        }
        Some(())
    }

    /// Whether each element by itself resists all motions of one of its nodes. One that is too long for the force that it carries need not, and then
    /// a way down may be its own and not the rod's.
    pub fn elements_resist(&self) -> bool {
        self.elements.iter().all(|element| element.positive == 6)
    }

    /// Factors the second variation and a drag (over `EI/L³`) times the measure of the motion. Gives how many ways lead down against that, or
    /// `None` where a pivot vanishes.
    pub fn factor(&mut self, drag: f64) -> Option<usize> {
        self.factors.clear();
        let (mut before, mut negative) = (Mat6::ZERO, 0);
        for (element, node) in self.elements.iter().zip(&self.nodes) {
            let factors = ldl(element.beside(&node.against(drag).add(&before)))?;
            let columns = element.by_far().map(|column| factors.solve(&column));
            let rows: [[f64; 6]; 6] = columns.map(|column| element.on_far(&column).map(|x| -x));
            before = symmetric(&Mat6::from_rows(&rows));
            negative += factors.negative();
            self.factors.push(factors);
        }
        let last = ldl(self.nodes.last()?.against(drag).add(&before).to_rows())?;
        negative += last.negative();
        self.last = Some(last);
        negative.checked_sub(self.elements.iter().map(|element| element.positive).sum())
    }

    /// Solves for the motions by what acts on the nodes, as last factored, in place.
    fn solve(&self, acting: &mut [Vec6]) {
        let Some(last) = &self.last else { return };
        let with_wrench = |motion: Vec6, wrench: Vec6| {
            let (a, b) = (motion.to_array(), wrench.to_array());
            core::array::from_fn::<f64, 12, _>(|i| if i < 6 { a[i] } else { b[i - 6] })
        };
        for (e, (element, factors)) in self.elements.iter().zip(&self.factors).enumerate() {
            let moved = factors.solve(&with_wrench(acting[e], Vec6::ZERO));
            acting[e + 1] -= Vec6::from(element.on_far(&moved));
        }
        let end = acting.len() - 1;
        acting[end] = Vec6::from(last.solve(&acting[end].to_array()));
        for (e, (element, factors)) in self.elements.iter().zip(&self.factors).enumerate().rev() {
            let far = acting[e + 1];
            let acts = acting[e] - element.half_turned.transpose().mul_vec(far);
            let moved = factors.solve(&with_wrench(acts, -far));
            acting[e] = Vec6::from(core::array::from_fn::<f64, 6, _>(|i| moved[i]));
        }
    }

    /// The motion of the nodes, of measure one and each in the node's frame, along which the energy falls most, and its second derivative along
    /// that (over `EI/L³`). `None` where it falls along none by more than `least`, and where a pivot vanishes.
    pub fn steepest(&mut self, least: f64) -> Option<(f64, Vec<Vec6>)> {
        let (mut falls, mut holds) = (least, least);
        while self.factor(holds)? > 0 {
            (falls, holds) = (holds, WIDER * holds);
        }
        if holds == least {
            return None;
        }
        while holds > CLOSE * falls {
            let between = (falls * holds).sqrt();
            if self.factor(between)? > 0 { falls = between } else { holds = between }
        }
        self.factor(holds)?;
        // From a load without symmetry.
        let n = self.nodes.len() as f64;
        let askew = Vec6::new(Vec3::new(-0.53, 0.41, 0.37), Vec3::new(0.61, 0.47, 0.53));
        let mut motion: Vec<Vec6> = (0..self.nodes.len()).map(|i| askew * (1.0 + i as f64 / n)).collect();
        let mut slope = f64::NAN;
        for _ in 0..MOST_ITERATIONS {
            let before = slope;
            let acting: Vec<Vec6> = self.measured(&motion).collect();
            let mut moved = acting.clone();
            self.solve(&mut moved);
            let dot = |a: Vec6, b: &Vec6| a.dot(*b);
            let along: f64 = acting.into_iter().zip(&moved).map(|(acting, moved)| dot(acting, moved)).sum();
            let size: f64 = self.measured(&moved).zip(&moved).map(|(acting, moved)| dot(acting, moved)).sum();
            slope = along / size - holds;
            let scale = 1.0 / size.sqrt();
            motion.iter_mut().zip(moved).for_each(|(motion, moved)| *motion = moved * scale);
            if (slope - before).abs() <= SETTLED * slope.abs() {
                break;
            }
        }
        slope.is_finite().then_some((slope, motion))
    }

    /// What a motion's drag on the nodes is, for a drag of one.
    fn measured<'a>(&'a self, motion: &'a [Vec6]) -> impl Iterator<Item = Vec6> + 'a {
        self.nodes
            .iter()
            .zip(motion)
            .map(|(node, motion)| Vec6::new(motion.angular * TURNING, motion.linear) * node.share)
    }
}

/// By what factor a drag that does not hold the rod is made larger, and how close to one that does it must be, as a factor, before the mode is
/// iterated on.
const WIDER: f64 = 32.0;
const CLOSE: f64 = 1.1;
/// The iterations on a mode end when its slope settles to this part, or after so many. The mode itself has then half as many digits.
const SETTLED: f64 = 1e-14;
const MOST_ITERATIONS: usize = 100;

impl Yielding {
    fn of(rod: &Rod, e: usize, axes: &Axes, state: &Record) -> Option<Self> {
        let relative = state.poses[e].between(&state.poses[e + 1]);
        // The strains of a general element are solved for where it is linearised.
        let strains = match (rod.order(), rod.diagonal_points()) {
            (Order::Second, Some(_)) => [relative.log() * (1.0 / rod.element_length(e)); 2],
            _ => state.strains[e],
        };
        let mut yields = element::flexibility_of(rod, e, state.wrenches[e], &strains, rod.order())?;
        let scales = [[axes.moment, axes.force], [axes.moment / axes.length, axes.force / axes.length]];
        for (blocks, scales) in yields.blocks.iter_mut().zip(scales) {
            blocks.iter_mut().zip(scales).for_each(|(block, scale)| *block = block.scaled(scale));
        }
        let half = element::coadjoint_by_strain(axes.wrench(state.wrenches[e])).scaled(0.5);
        // The inverse of the symmetric part of its inverse, F + A/2.
        let factors = lu::<6>(Mat6::IDENTITY.add(&yields.mul(&half)).to_rows())?;
        let columns = yields.transpose().to_rows().map(|column| factors.solve(&column));
        let flexibility = symmetric(&Mat6::from_rows(&columns));
        let rigid = RIGID * largest(&flexibility.to_rows().map(|row| largest(&row)));
        let positive = 6 - ldl(flexibility.add(&Mat6::IDENTITY.scaled(rigid)).to_rows())?.negative();
        let relative = Pose { position: relative.position * (1.0 / axes.length), ..relative };
        let to_far = relative.inverse().adjoint_matrix();
        Some(Self { flexibility, positive, to_far, half_turned: half.mul(&to_far) })
    }

    /// The equations of the motion of the near node, against a resistance there, and of the wrench.
    fn beside(&self, resistance: &Mat6) -> [[f64; 12]; 12] {
        let [resistance, flexibility, to_far] =
            [resistance, &self.flexibility, &self.to_far].map(Mat6::to_rows);
        core::array::from_fn(|r| {
            core::array::from_fn(|c| match (r < 6, c < 6) {
                (true, true) => resistance[r][c],
                (true, false) => -to_far[c - 6][r],
                (false, true) => -to_far[r - 6][c],
                (false, false) => -flexibility[r - 6][c - 6],
            })
        })
    }

    /// How those follow from each motion of the far node.
    fn by_far(&self) -> [[f64; 12]; 6] {
        let half = self.half_turned.to_rows();
        core::array::from_fn(|k| {
            core::array::from_fn(|r| if r < 6 { half[k][r] } else { f64::from(u8::from(r - 6 == k)) })
        })
    }

    /// What the motion of the near node and the wrench exert on the far node.
    fn on_far(&self, moved: &[f64; 12]) -> [f64; 6] {
        let part = |from: usize| Vec6::from(core::array::from_fn::<f64, 6, _>(|i| moved[from + i]));
        (self.half_turned.mul_vec(part(0)) + part(6)).to_array()
    }
}

impl Node {
    /// Its resistance, and that of a drag times the measure of a motion, `∫ |shift|² + TURNING |turn|²`.
    fn against(&self, drag: f64) -> Mat6 {
        let drag = drag * self.share;
        let turning = drag * TURNING;
        let [turning, shifting] = [turning, drag].map(|x| Vec3::new(x, x, x));
        self.resistance.add(&Mat6::diagonal(Vec6::new(turning, shifting)))
    }
}

fn symmetric(matrix: &Mat6) -> Mat6 {
    matrix.add(&matrix.transpose()).scaled(0.5)
}

impl Hold<f64> {
    fn free(&self) -> Mat6 {
        Mat6::from_rows(&self.free)
    }

    /// The free displacements, one a row, of a motion: `(BᵀB)⁻¹ Bᵀ`. `None` where they are not independent.
    fn parts(&self) -> Option<Mat6> {
        let (free, fixed) = (self.free(), Mat6::diagonal(Vec6::from(self.fixed)));
        let factors = lu::<6>(free.transpose().mul(&free).add(&fixed).to_rows())?;
        let columns = self.free.map(|column| factors.solve(&column));
        Some(Mat6::from_rows(&columns).transpose())
    }

    /// Its resistance: what comes from how its free displacements turn, and `stiff` against all others.
    fn resistance(&self, stiff: f64) -> Option<Mat6> {
        let parts = self.parts()?;
        let rest = Mat6::IDENTITY.add(&self.free().mul(&parts).scaled(-1.0));
        let curved = Mat6::from_rows(&self.curved);
        Some(parts.transpose().mul(&curved).mul(&parts).add(&rest.scaled(stiff)))
    }
}

impl Nodal {
    /// Takes from a motion of the nodes, each in its own frame, what the supports do not allow.
    pub fn keep_to_holds(&self, state: &Record, motion: &mut [Vec6]) {
        for hold in &self.holds {
            let frame = state.poses[hold.node].from_itself();
            let step = frame.adjoint_matrix().mul_vec(motion[hold.node]);
            let allowed = hold.parts().map_or(Vec6::ZERO, |parts| hold.free().mul_vec(parts.mul_vec(step)));
            motion[hold.node] = frame.inverse().adjoint_matrix().mul_vec(allowed);
        }
    }
}
