use super::*;
use crate::math::Mat6;

#[test]
fn torsion_constants_match_the_tables() {
    // Timoshenko & Goodier, Theory of Elasticity, art. 109: k₁ of J = k₁ b³ a for a/b = 1, 2, 10 (a ≥ b).
    for (ratio, k1) in [(1.0, 0.1406), (2.0, 0.229), (10.0, 0.312)] {
        for (width, height) in [(ratio, 1.0), (1.0, ratio)] {
            let j = Section::Rectangle { width, height }.torsion_constant();
            assert!((j / ratio - k1).abs() < 6e-4, "{ratio}: {}", j / ratio);
        }
    }
    let circle = Section::Circle { radius: 2.0 };
    let ellipse = Section::Ellipse { a: 2.0, b: 2.0 };
    assert!((circle.torsion_constant() - ellipse.torsion_constant()).abs() < 1e-12);
    // A strip: J → w h³/3.
    let strip = Section::Rectangle { width: 1e4, height: 1.0 }.torsion_constant();
    assert!((strip / (1e4 / 3.0) - 1.0).abs() < 1e-4);
}

#[test]
fn shear_factors_match_cowper() {
    for nu in [0.0, 0.3, 0.5] {
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        let circle = Section::Circle { radius: 1.0 }.shear_factors(nu)[0];
        near(circle, Section::Ellipse { a: 1.0, b: 1.0 }.shear_factors(nu)[0]);
        near(circle, Section::Annulus { outer_radius: 1.0, inner_radius: 0.0 }.shear_factors(nu)[1]);
    }
    // Cowper's table, ν = 0.3: circle 0.886, rectangle 0.850, thin tube 0.531.
    let at = |section: Section| section.shear_factors(0.3)[0];
    assert!((at(Section::Circle { radius: 1.0 }) - 0.886).abs() < 5e-4);
    assert!((at(Section::Rectangle { width: 1.0, height: 2.0 }) - 0.850).abs() < 5e-4);
    assert!((at(Section::Annulus { outer_radius: 1.0, inner_radius: 0.9999 }) - 0.531).abs() < 5e-4);
}

#[test]
fn second_moments_are_about_the_directors() {
    // Wide along d1: stiff against bending about d2.
    let [i1, i2] = Section::Rectangle { width: 4.0, height: 1.0 }.second_moments();
    assert_eq!([i1, i2], [4.0 / 12.0, 64.0 / 12.0]);
}

#[test]
fn a_taper_is_linear_and_a_step_is_a_break() {
    let material = Material::from_poisson(1e9, 0.3, 1000.0).unwrap();
    let station = |s, radius| Station { s, section: Section::Circle { radius }, material };
    let description = RodDescription {
        length: 1.0,
        kinematics: Kinematics::Kirchhoff,
        profile: Profile::Stations(vec![station(0.0, 2e-3), station(0.6, 1e-3), station(0.6, 0.5e-3)]),
        rest: RestShape::default(),
        base: Pose::IDENTITY,
    };
    let rod = Rod::with_elements(description, 20, &[], Order::Second).unwrap();
    let radius = |s| rod.half_extent()[rod.mesh().node_at(s).unwrap()][0];
    assert!((radius(0.3) - 1.5e-3).abs() < 1e-15);
    assert_eq!(radius(1.0), 0.5e-3);
    assert_eq!(rod.mesh().spans().len(), 2);
    // The frustum's volume plus the thin part's, by the trapezoidal rule.
    let exact = core::f64::consts::PI * (0.6 * (4.0 + 2.0 + 1.0) / 3.0 + 0.4 * 0.25) * 1e-6 * 1000.0;
    let mass = rod.mass();
    assert!((mass / exact - 1.0).abs() < 2e-3, "{mass} {exact}");
}

#[test]
fn a_polyline_along_a_helix_has_the_helix_curvature_and_no_twist_of_its_own() {
    let (radius, rise) = (0.03, 0.004);
    let speed = f64::hypot(radius, rise);
    let points: Vec<Vec3> = (0..=400)
        .map(|i| {
            let t = i as f64 * 0.05;
            Vec3::new(radius * t.cos(), radius * t.sin(), rise * t)
        })
        .collect();
    let curve = RestShape::polyline(&points).unwrap();
    assert!((curve.length / (400.0 * 0.05 * speed) - 1.0).abs() < 2e-4);
    let curvature = curve.shape.curvature(0.5 * curve.length, curve.length);
    assert!((curvature.norm() * speed * speed / radius - 1.0).abs() < 1e-3);
    assert_eq!(curvature.z, 0.0);
}

/// How far the end of a rod along `n` sides of a curve is from the curve's end, over its length.
fn gap_of_the_end(n: usize, curve: impl Fn(f64) -> Vec3) -> f64 {
    // Sides of different lengths, as a file has them.
    let place = |i: usize| {
        let x = i as f64 / n as f64;
        x + 0.3 * x * (1.0 - x)
    };
    let points: Vec<Vec3> = (0..=n).map(|i| curve(place(i))).collect();
    let rest = RestShape::polyline(&points).unwrap();
    let law = Law::Diagonal(Stiffness { bending: [1.0; 2], torsion: 1.0, axial: 1.0, shear: [1.0; 2] });
    let description = RodDescription {
        length: rest.length,
        kinematics: Kinematics::Kirchhoff,
        profile: Profile::Given {
            law,
            mass_per_length: 0.0,
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [0.0; 2],
        },
        rest: rest.shape,
        base: rest.start,
    };
    let rod = Rod::with_elements(description, 64 * n, &[], Order::Fourth).unwrap();
    let end = rod.rest_poses()[rod.elements()].position;
    (end - points[n]).norm() / rest.length
}

#[test]
fn a_rod_along_a_polyline_ends_where_it_ends_to_second_order() {
    let half_circle = |x: f64| {
        let angle = core::f64::consts::PI * x;
        Vec3::new(angle.cos(), angle.sin(), 0.0)
    };
    let helix = |x: f64| {
        let angle = 4.0 * x;
        Vec3::new(0.3 * angle.cos(), 0.3 * angle.sin(), 0.1 * angle)
    };
    for n in [10, 20, 40] {
        for (name, slope) in [
            ("half circle", (gap_of_the_end(n, half_circle) / gap_of_the_end(2 * n, half_circle)).log2()),
            ("helix", (gap_of_the_end(n, helix) / gap_of_the_end(2 * n, helix)).log2()),
        ] {
            assert!((slope - 2.0).abs() < 0.2, "{name} from {n} sides: slope {slope:.3}");
        }
    }
    assert!(gap_of_the_end(10, half_circle) < 0.02, "{}", gap_of_the_end(10, half_circle));
}

#[test]
fn what_is_wrong_is_said() {
    let say = |error: RodError| error.to_string();
    let bad = Material::from_poisson(1e9, 0.7, 1.0).unwrap_err();
    assert_eq!(say(bad), "poisson_ratio is 0.7, but must be more than -1 and at most 0.5");
    let bad = Section::Annulus { outer_radius: 1.0, inner_radius: 2.0 }.validate().unwrap_err();
    assert_eq!(say(bad), "inner_radius is 2, but must be less than outer_radius");
    let bad = RestShape::polyline(&[Vec3::ZERO, Vec3::X, Vec3::ZERO]).unwrap_err();
    assert!(say(bad).contains("folds back"));
    let mut matrix = Mat6Rows::identity();
    matrix[2][2] = -1.0;
    assert_eq!(Law::full(matrix).unwrap_err(), RodError::NotPositiveDefinite { row: 2 });
    matrix[0][1] = 0.5;
    assert!(matches!(Law::full(matrix), Err(RodError::NotSymmetric { .. })));
}

#[test]
fn a_rod_of_numbers_that_are_none_is_refused() {
    let material = Material::from_poisson(1e9, 0.3, 1000.0).unwrap();
    let good = || RodDescription {
        length: 1.0,
        kinematics: Kinematics::Cosserat,
        profile: Profile::Stations(vec![Station {
            s: 0.0,
            section: Section::Circle { radius: 1e-3 },
            material,
        }]),
        rest: RestShape::default(),
        base: Pose::IDENTITY,
    };
    let of = |material: Material, radius: f64| {
        let section = Section::Circle { radius };
        RodDescription { profile: Profile::Stations(vec![Station { s: 0.0, section, material }]), ..good() }
    };
    let given = |law: Law, mass_per_length: f64, width: f64| {
        let profile = Profile::Given {
            law,
            mass_per_length,
            rotational_inertia_per_length: Vec3::ZERO,
            half_extent: [width, 0.0],
        };
        RodDescription { profile, ..good() }
    };
    let rest = |rest: RestShape| RodDescription { rest, ..good() };
    let base = |base: Pose| RodDescription { base, ..good() };
    let stiffness = Stiffness { bending: [1.0; 2], torsion: 1.0, axial: 1.0, shear: [1.0; 2] };
    let energy = |torsion: f64| {
        let stiffness = Stiffness { torsion, ..stiffness };
        let doubling_strain = Strain::from([1.0; 6]);
        Law::Hyperelastic(std::sync::Arc::new(StiffeningEnergy { stiffness, doubling_strain }))
    };
    let mut matrix = Mat6Rows::identity();
    matrix[4][4] = -1.0;
    let nan = Vec3::new(0.0, f64::NAN, 0.0);
    let doubled = Pose { rotation: Pose::IDENTITY.rotation.scaled(2.0), position: Vec3::ZERO };
    let mirrored = Pose { rotation: Pose::IDENTITY.rotation.scaled(-1.0), position: Vec3::ZERO };
    let bad = [
        ("E < 0", of(Material { youngs_modulus: -1.0, ..material }, 1e-3)),
        ("G = NaN", of(Material { shear_modulus: f64::NAN, ..material }, 1e-3)),
        ("ρ < 0", of(Material { density: -1.0, ..material }, 1e-3)),
        ("EI = 0 by underflow", of(material, 1e-90)),
        ("base at NaN", base(Pose { position: nan, ..Pose::IDENTITY })),
        ("a base of no unit vectors", base(doubled)),
        ("a left-handed base", base(mirrored)),
        ("no sample", rest(RestShape::Samples(Vec::new()))),
        ("a sample of NaN", rest(RestShape::Samples(vec![(0.0, nan)]))),
        ("samples that fall", rest(RestShape::Samples(vec![(0.5, Vec3::X), (0.2, Vec3::X)]))),
        ("rest curvature NaN", rest(RestShape::Constant(nan))),
        ("a matrix that is not positive", given(Law::Full(Box::new(Mat6::from_rows(&matrix))), 1.0, 0.0)),
        ("an energy that is not positive", given(energy(-1.0), 1.0, 0.0)),
        ("mass NaN", given(Law::Diagonal(stiffness), f64::NAN, 0.0)),
        ("width < 0", given(Law::Diagonal(stiffness), 1.0, -1.0)),
    ];
    for (what, description) in bad {
        let rod = Rod::with_elements(description, 10, &[], Order::Second);
        assert!(rod.is_err(), "{what} was accepted");
    }
    for description in [good(), given(energy(1.0), 1.0, 0.0)] {
        assert!(Rod::with_elements(description, 10, &[], Order::Second).is_ok());
    }
}

struct Mat6Rows;

impl Mat6Rows {
    fn identity() -> [[f64; 6]; 6] {
        core::array::from_fn(|i| core::array::from_fn(|j| f64::from(u8::from(i == j))))
    }
}
