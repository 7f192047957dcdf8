//! The numbers of which a wild problem is made, and the small things made of a few: vectors, laws, supports, hands.

use core::f64::consts::PI;
use fastrand::Rng;
use strands::coupling::{Grip, VirtualCoupling};
use strands::math::{Mat6, Pose, Quat, Vec3};
use strands::rod::{Law, RestShape, Stiffness};
use strands::statics::Support;

/// What is drawn at random; the same number gives the same things.
pub struct Draw(Rng);

impl Draw {
    pub fn new(number: u64) -> Self {
        // Neighbouring seeds give unlike numbers only after some are thrown away.
        let mut random = Rng::with_seed(number);
        (0..8).for_each(|_| _ = random.f64());
        Self(random)
    }

    /// True once in so many times.
    pub fn once_in(&mut self, times: u32) -> bool {
        self.0.u32(..times) == 0
    }

    pub fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.0.usize(..all.len())]
    }

    pub fn whole(&mut self, from: usize, to: usize) -> usize {
        self.0.usize(from..=to)
    }

    /// A number from zero to one.
    pub fn part(&mut self) -> f64 {
        self.0.f64()
    }

    /// A number of which the power of ten lies evenly between two.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(low + (high - low) * self.part())
    }

    pub fn vector(&mut self, size: f64) -> Vec3 {
        let mut part = || 2.0 * self.part() - 1.0;
        Vec3::new(part(), part(), part()) * size
    }

    pub fn turn(&mut self, largest: f64) -> Quat {
        Quat::from_rotation_vector(self.vector(largest))
    }

    /// A law of about a bending stiffness, one in eight with couplings between its strains. `spread` is by how many powers of ten its stiffnesses
    /// differ.
    pub fn law(&mut self, bending: f64, stretch: f64, spread: f64) -> Law {
        let stiffness = Stiffness {
            bending: [bending, bending * self.power(-spread, spread)],
            torsion: bending * self.power(-spread, spread),
            axial: stretch,
            shear: [(); 2].map(|()| stretch * self.power(-spread, 1.0)),
        };
        let diagonal = Law::Diagonal(stiffness);
        if !self.once_in(8) {
            return diagonal;
        }
        let [b, s] = [stiffness.bending, stiffness.shear];
        let stiffnesses = [b[0], b[1], stiffness.torsion, s[0], s[1], stiffness.axial];
        let mut rows = Mat6::IDENTITY.to_rows();
        for i in 0..6 {
            rows[i][i] = stiffnesses[i];
            for j in 0..i {
                let coupling = 0.3 * (self.part() - 0.5) * (stiffnesses[i] * stiffnesses[j]).sqrt();
                (rows[i][j], rows[j][i]) = (coupling, coupling);
            }
        }
        Law::full(rows).unwrap_or(diagonal)
    }

    /// Straight, evenly bent, or bent and twisted otherwise at each of a few places.
    pub fn rest_shape(&mut self, length: f64, spread: f64) -> RestShape {
        let turns = PI * self.power(-1.0, spread.min(1.0)) / length;
        match self.whole(0, 4) {
            0 | 1 => RestShape::default(),
            2 | 3 => RestShape::Constant(self.vector(turns)),
            _ => RestShape::Samples([0.0, 0.5, 1.0].map(|s| (s * length, self.vector(turns))).to_vec()),
        }
    }

    /// A frame near another, most often, and else as far away as `far` powers of ten of the length.
    pub fn pose_about(&mut self, pose: &Pose, length: f64, far: f64) -> Pose {
        let away = self.power(-6.0, far);
        let turn = self.turn(away.min(PI)).to_matrix();
        Pose { rotation: pose.rotation * turn, position: pose.position + self.vector(away * length) }
    }

    /// A support somewhere about where the rod is anyway.
    pub fn support(&mut self, rest: &Pose, length: f64, far: f64) -> Support {
        let fixed = match self.whole(0, 3) {
            0 => [true; 6],
            1 => [false, false, false, true, true, true],
            _ => core::array::from_fn(|_| self.once_in(2)),
        };
        let support = Support::of(fixed, self.pose_about(rest, length, far));
        match self.whole(0, 7) {
            0 => support.sliding_along(self.vector(1.0) + Vec3::Z * 2.0),
            1 => support.turning_about(self.vector(1.0) + Vec3::X * 2.0),
            2 => support
                .sliding_along(self.vector(1.0) + Vec3::Y * 2.0)
                .turning_about(self.vector(1.0) + Vec3::Z * 2.0),
            _ => support,
        }
    }

    /// A hand about where the rod is, as stiff as the rod or otherwise.
    pub fn hand(&mut self, rest: &Pose, length: f64, bending: f64, far: f64) -> Support {
        let force = bending / (length * length);
        let coupling = VirtualCoupling {
            linear_stiffness: self.power(-2.0, 3.0) * force / length,
            angular_stiffness: self.power(-2.0, 3.0) * force * length,
            linear_damping: 0.0,
            angular_damping: 0.0,
            max_force: self.power(-1.0, 3.0) * force,
            max_torque: self.power(-1.0, 3.0) * force * length,
        };
        Support::gripped(Grip { coupling, hand: self.pose_about(rest, length, far), last: None })
    }
}
