//! The numbers by which a rod's difficulty is known: slenderness, loads over its stiffness, length over bending length.

use super::View;
use strands::load::Frame;
use strands::math::{Strain, Vec3};
use strands::rod::{Kinematics, Law, Profile, Rod};
use strands::statics::Stretch;

/// Sizes, stiffnesses and loads of a rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbers {
    /// Rest length `L`, m.
    pub length: f64,
    /// Half the section's largest extent, m; `None` where a stiffness is given in place of a section.
    pub radius: Option<f64>,
    /// Radius of gyration of the softer bending, `√(EI/EA) = √(I/A)`, m, the largest along the rod; `None` where there is no `EA`.
    pub gyration: Option<f64>,
    /// Bending stiffness `EI`, N·m²: the softer of the two, averaged along the rod.
    pub bending: f64,
    /// Weight and distributed forces `w`, N/m: all together over the length.
    pub weight: f64,
    /// Forces at points `P`, N, all together.
    pub force: f64,
    /// Moments at points `M`, N·m, all together.
    pub moment: f64,
    /// The tension `T`.
    pub tension: Tension,
}

/// The tension of a rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tension {
    /// The largest, N; zero where the rod is nowhere pulled.
    pub value: f64,
    /// Whether it was found by a solve; else it is what loads and supports can bring about at most.
    pub found: bool,
}

impl Numbers {
    /// The numbers before anything is solved.
    pub(super) fn expected(view: &View<'_>) -> Self {
        let rod = &view.rod.problem.rod;
        let loads = &view.rod.loads;
        let length = rod.length();
        let mut dead = loads.gravity * rod.mass();
        let mut following = 0.0;
        for load in &loads.stretches {
            let force = load.per_length.linear * (load.to - load.from);
            match load.frame {
                Frame::World => dead += force,
                Frame::Body => following += force.norm(),
            }
        }
        following += loads
            .pulled_stretches
            .iter()
            .map(|pull| (pull.tension_per_length * (pull.to - pull.from)).abs())
            .sum::<f64>();
        let points = |of: &dyn Fn(&strands::load::PointLoad) -> f64| {
            loads.points.iter().map(of).fold(0.0, |sum, x| sum + x)
        };
        let numbers = Self {
            length,
            radius: radius(rod),
            gyration: gyration(rod),
            bending: softer_bending(rod),
            weight: (dead.norm() + following) / length,
            force: points(&|load| load.wrench.linear.norm())
                + loads.pulls.iter().map(|pull| pull.tension.abs()).sum::<f64>(),
            moment: points(&|load| load.wrench.angular.norm()),
            tension: Tension { value: 0.0, found: false },
        };
        let loaded = numbers.weight * length + numbers.force;
        let stretches = view.rod.problem.stretches();
        let tensions = stretches.iter().map(|stretch| tension(stretch, rod, numbers.weight));
        let value = tensions.fold(loaded, f64::max);
        Self { tension: Tension { value, found: false }, ..numbers }
    }

    /// `w L³/EI`: up to about 1 a rod hardly sags, from about 100 on it hangs as a chain does.
    pub fn weight_parameter(&self) -> f64 {
        self.weight * self.length.powi(3) / self.bending
    }

    /// `P L²/EI`.
    pub fn force_parameter(&self) -> f64 {
        self.force * self.length.powi(2) / self.bending
    }

    /// `M L/EI`: the angle, rad, by which the moment bends the rod.
    pub fn moment_parameter(&self) -> f64 {
        self.moment * self.length / self.bending
    }

    /// The length `ℓ = √(EI/T)` over which the rod bends under its tension, m; infinite where there is none.
    pub fn bending_length(&self) -> f64 {
        (self.bending / self.tension.value).sqrt()
    }

    /// `L/ℓ`.
    pub fn bending_lengths(&self) -> f64 {
        self.length / self.bending_length()
    }

    /// The factor `exp(L/ℓ)` by which shooting multiplies round-off.
    pub fn shooting_loses(&self) -> f64 {
        self.bending_lengths().exp()
    }
}

/// Less to spare than this part of the length counts as none.
const LEAST_SPARE: f64 = 1e-6;

/// The tension that holding the ends of a stretch so brings about, N: `EA` times what it is stretched by, or where it hangs nearly straight that of
/// a chain, whose length to spare is `(wL)²/24T²` of it.
fn tension(stretch: &Stretch, rod: &Rod, weight: f64) -> f64 {
    let spare = stretch.spare();
    if spare > LEAST_SPARE {
        return if spare < 0.1 { weight * stretch.length / (24.0 * spare).sqrt() } else { 0.0 };
    }
    match rod.kinematics() {
        Kinematics::Cosserat => axial(rod).unwrap_or(0.0) * (-spare).max(0.0),
        Kinematics::Kirchhoff => 0.0,
    }
}

/// The least axial stiffness `EA` along a rod, N; `None` where none was given.
pub(super) fn axial(rod: &Rod) -> Option<f64> {
    // A Kirchhoff rod of a given stiffness does without; what stands there has no meaning.
    if rod.kinematics() == Kinematics::Kirchhoff && matches!(rod.description().profile, Profile::Given { .. })
    {
        return None;
    }
    diagonals(rod).map(|[_, _, axial]| axial).reduce(f64::min)
}

/// The softer bending stiffness, averaged along a rod, N·m².
pub(super) fn softer_bending(rod: &Rod) -> f64 {
    let (sum, n) = diagonals(rod).fold((0.0, 0.0), |(sum, n), [a, b, _]| (sum + a.min(b), n + 1.0));
    sum / n
}

/// `EI1`, `EI2` and `EA` wherever the law is taken.
fn diagonals(rod: &Rod) -> impl Iterator<Item = [f64; 3]> + '_ {
    (0..rod.elements()).flat_map(|e| rod.points(e)).map(|point| match &point.law {
        Law::Diagonal(stiffness) => [stiffness.bending[0], stiffness.bending[1], stiffness.axial],
        law => {
            let c = law.tangent(Strain::ZERO).to_rows();
            [c[0][0], c[1][1], c[5][5]]
        }
    })
}

fn gyration(rod: &Rod) -> Option<f64> {
    axial(rod)?;
    diagonals(rod).map(|[a, b, axial]| (a.min(b) / axial).sqrt()).reduce(f64::max)
}

/// Half the largest extent of a section; `None` where there is no section, and an extent is for drawing only.
pub(super) fn radius(rod: &Rod) -> Option<f64> {
    let Profile::Stations(_) = rod.description().profile else { return None };
    rod.half_extent().iter().map(|half| half[0].max(half[1])).reduce(f64::max)
}

/// The section's smallest extent, m, where it is thickest; `None` as for [`radius`].
pub(super) fn thickness(rod: &Rod) -> Option<f64> {
    radius(rod)?;
    rod.half_extent().iter().map(|half| 2.0 * half[0].min(half[1])).reduce(f64::max)
}

/// The largest curvature of the rest shape, 1/m, and where, m.
pub(super) fn rest_curvature(rod: &Rod) -> (f64, f64) {
    let nodes = rod.mesh().nodes();
    (0..rod.elements())
        .flat_map(|e| rod.points(e).iter().map(move |point| (bend(point.rest.angular), e)))
        .map(|(bend, e)| (bend, 0.5 * (nodes[e] + nodes[e + 1])))
        .fold((0.0, 0.0), |most, here| if here.0 > most.0 { here } else { most })
}

/// The curvature without the twist.
pub(super) fn bend(u: Vec3) -> f64 {
    u.x.hypot(u.y)
}
