//! A scene that is written reads back as the same scene; the schema says what is read.

use indexmap::IndexMap;
use proptest::prelude::*;
use strands_scene::*;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![-1e3..1e3_f64, 1e-9..1e-3_f64, Just(0.0), (-5..5_i32).prop_map(f64::from)]
}

fn positive() -> impl Strategy<Value = f64> {
    prop_oneof![1e-6..1e6_f64, Just(1.0)]
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    [number(), number(), number()]
}

fn word() -> impl Strategy<Value = String> {
    prop_oneof!["[a-z_]{1,8}", r#"[ -~äµ"'\\.\[\]]{1,8}"#]
}

fn place() -> impl Strategy<Value = Place> {
    prop_oneof![Just(Place::Start), Just(Place::End), number().prop_map(Place::At)]
}

fn material() -> impl Strategy<Value = MaterialFile> {
    (
        positive(),
        prop::option::of(number()),
        prop::option::of(positive()),
        number(),
        prop::option::of(number()),
    )
        .prop_map(|(youngs_modulus, poisson_ratio, shear_modulus, density, damping)| MaterialFile {
            youngs_modulus,
            poisson_ratio,
            shear_modulus,
            density,
            damping,
        })
}

fn section() -> impl Strategy<Value = SectionFile> {
    let shape = prop::sample::select(vec![
        ShapeName::Circle,
        ShapeName::Annulus,
        ShapeName::Ellipse,
        ShapeName::Rectangle,
    ]);
    let size = || prop::option::of(positive());
    (shape, [size(), size(), size(), size(), size(), size(), size(), size()], prop::option::of(word()))
        .prop_map(|(shape, [s, radius, outer_radius, inner_radius, a, b, width, height], material)| {
            SectionFile { s, shape, radius, outer_radius, inner_radius, a, b, width, height, material }
        })
}

fn sections() -> impl Strategy<Value = SectionsFile> {
    prop_oneof![
        section().prop_map(SectionsFile::One),
        prop::collection::vec(section(), 0..3).prop_map(SectionsFile::Stations)
    ]
}

fn stiffness() -> impl Strategy<Value = StiffnessFile> {
    let pair = || prop::option::of([positive(), positive()]);
    let matrix = prop::collection::vec(number(), 36)
        .prop_map(|flat| std::array::from_fn(|i| std::array::from_fn(|j| flat[6 * i + j])));
    (pair(), prop::option::of(positive()), prop::option::of(positive()), pair(), prop::option::of(matrix))
        .prop_map(|(bending, torsion, axial, shear, matrix)| StiffnessFile {
            bending,
            torsion,
            axial,
            shear,
            matrix,
        })
}

fn rest() -> impl Strategy<Value = RestFile> {
    let sample = (number(), vector()).prop_map(|(s, curvature)| RestSample { s, curvature });
    let helix = (number(), number()).prop_map(|(radius, pitch)| HelixFile { radius, pitch });
    (
        prop::option::of(vector()),
        prop::option::of(prop::collection::vec(sample, 0..3)),
        prop::option::of(helix),
        prop::option::of(prop::collection::vec(vector(), 0..3)),
        prop::option::of(word()),
    )
        .prop_map(|(curvature, samples, helix, points, csv)| RestFile {
            curvature,
            samples,
            helix,
            points,
            csv,
        })
}

fn initial() -> impl Strategy<Value = InitialFile> {
    let helix = (number(), number()).prop_map(|(radius, pitch)| HelixFile { radius, pitch });
    let points = prop::collection::vec(vector(), 0..3);
    (prop::option::of(points), prop::option::of(word()), prop::option::of(helix), prop::option::of(number()))
        .prop_map(|(points, csv, helix, twist)| InitialFile { points, csv, helix, twist })
}

fn quaternion() -> impl Strategy<Value = [f64; 4]> {
    [number(), number(), number(), number()]
}

fn body_support() -> impl Strategy<Value = BodySupportFile> {
    use FixName::*;
    let fix = prop::sample::subsequence(vec![X, Y, Z, Position, Orientation, Tangent, Twist], 0..4);
    let place = || (prop::option::of(vector()), prop::option::of(quaternion()));
    let keyframe = (number(), place());
    let keyframe =
        keyframe.prop_map(|(t, (position, orientation))| KeyframeFile { t, position, orientation });
    let axes = (prop::option::of(vector()), prop::option::of(vector()));
    (fix, place(), axes, prop::collection::vec(keyframe, 0..3)).prop_map(
        |(fix, (position, orientation), (slide_along, turn_about), motion)| BodySupportFile {
            fix,
            position,
            orientation,
            slide_along,
            turn_about,
            motion,
        },
    )
}

fn support() -> impl Strategy<Value = SupportFile> {
    (place(), body_support()).prop_map(|(at, of_body)| {
        let BodySupportFile { fix, position, orientation, slide_along, turn_about, motion } = of_body;
        SupportFile { at, fix, position, orientation, slide_along, turn_about, motion }
    })
}

fn body() -> impl Strategy<Value = BodyFile> {
    use BodyShapeName::*;
    let shape = prop::sample::select(vec![Ball, Capsule, Cylinder, Block, Ring]);
    let size = || prop::option::of(positive());
    let shape = (shape, [size(), size(), size()], prop::option::of(vector()));
    let shape = shape.prop_map(|(shape, [radius, wire_radius, length], size)| BodyShapeFile {
        shape,
        radius,
        wire_radius,
        length,
        size,
    });
    let vectors = || prop::option::of(vector());
    (
        (word(), prop::option::of(shape), size(), size(), vectors()),
        (vectors(), prop::option::of(quaternion()), vectors(), vectors()),
        (prop::option::of(body_support()), prop::option::of(tissue())),
    )
        .prop_map(
            |(
                (name, shape, density, mass, inertia),
                (position, orientation, velocity, angular_velocity),
                (support, tissue),
            )| BodyFile {
                name,
                shape,
                density,
                mass,
                inertia,
                position,
                orientation,
                velocity,
                angular_velocity,
                tissue,
                support,
            },
        )
}

fn joint() -> impl Strategy<Value = JointFile> {
    let kind = prop::sample::select(vec![JointName::Rigid, JointName::Ball, JointName::Hinge]);
    let end = || {
        (prop::option::of(word()), prop::option::of(place()), prop::option::of(word()))
            .prop_map(|(rod, at, body)| JointEndFile { rod, at, body })
    };
    (kind, [end(), end()], prop::option::of(vector()), prop::option::of(vector()))
        .prop_map(|(kind, between, position, axis)| JointFile { kind, between, position, axis })
}

fn load() -> impl Strategy<Value = LoadFile> {
    let place = || prop::option::of(place());
    let vector = || prop::option::of(vector());
    let frame = prop::option::of(prop::sample::select(vec![FrameName::World, FrameName::Body]));
    let pull = (vector(), prop::option::of(number()), prop::option::of(number()));
    (place(), place(), place(), [vector(), vector(), vector(), vector()], pull, frame).prop_map(
        |(at, from, to, [force, moment, force_per_length, moment_per_length], pull, frame)| LoadFile {
            at,
            from,
            to,
            force,
            moment,
            force_per_length,
            moment_per_length,
            towards: pull.0,
            tension: pull.1,
            tension_per_length: pull.2,
            frame,
        },
    )
}

fn rod() -> impl Strategy<Value = RodFile> {
    let kinematics = prop::sample::select(vec![KinematicsName::Cosserat, KinematicsName::Kirchhoff]);
    let mass_matrix = prop::sample::select(vec![MassMatrixName::Lumped, MassMatrixName::Consistent]);
    let mesh = (prop::option::of(0..1000_usize), prop::option::of(positive()));
    let given = (prop::option::of(stiffness()), prop::option::of(number()), prop::option::of(vector()));
    let base = (prop::option::of(vector()), prop::option::of([number(), number(), number(), number()]));
    (
        (prop::option::of(word()), prop::option::of(positive()), mesh, prop::option::of(sections())),
        (prop::option::of(kinematics), given, (prop::option::of(rest()), prop::option::of(initial())), base),
        prop::collection::vec(support(), 0..3),
        prop::collection::vec(load(), 0..3),
        prop::option::of((prop::option::of(number()), prop::option::of(number()))),
        prop::option::of(mass_matrix),
    )
        .prop_map(
            |(
                (material, length, (elements, tolerance), section),
                (
                    kinematics,
                    (stiffness, mass_per_length, rotational_inertia_per_length),
                    (rest, initial),
                    (position, orientation),
                ),
                supports,
                loads,
                drag,
                mass_matrix,
            )| RodFile {
                material,
                length,
                elements,
                tolerance,
                section,
                kinematics,
                stiffness,
                mass_per_length,
                rotational_inertia_per_length,
                rest,
                position,
                orientation,
                initial,
                supports,
                loads,
                drag: drag.map(|(linear, quadratic)| DragFile { linear, quadratic }),
                mass_matrix,
            },
        )
}

fn coupling() -> impl Strategy<Value = CouplingFile> {
    let limit = || prop::option::of(positive());
    (word(), prop::option::of(place()), positive(), positive(), [limit(), limit(), limit(), limit()])
        .prop_map(
            |(
                rod,
                at,
                linear_stiffness,
                angular_stiffness,
                [linear_damping, angular_damping, max_force, max_torque],
            )| {
                CouplingFile {
                    hand: HandFile {
                        rod,
                        at,
                        linear_stiffness,
                        angular_stiffness,
                        linear_damping,
                        angular_damping,
                        max_force,
                        max_torque,
                    },
                }
            },
        )
}

fn solver() -> impl Strategy<Value = SolverFile> {
    use JacobianName::*;
    let method = prop::sample::select(vec![
        MethodName::Auto,
        MethodName::Sweep,
        MethodName::Shooting,
        MethodName::MultipleShooting,
        MethodName::Equilibrium,
    ]);
    let jacobian = vec![Variational, VariationalLanes, FiniteDifferences, FiniteDifferenceLanes];
    let scheme = prop::sample::select(vec![SchemeName::Element, SchemeName::Multistep]);
    (
        prop::option::of(method),
        prop::option::of(0..9_usize),
        prop::option::of(positive()),
        prop::option::of(0..99_usize),
        prop::option::of(prop::sample::select(jacobian)),
        prop::option::of(scheme),
    )
        .prop_map(|(method, order, tolerance, max_iterations, jacobian, scheme)| SolverFile {
            method,
            order,
            tolerance,
            max_iterations,
            jacobian,
            scheme,
        })
}

fn dynamics() -> impl Strategy<Value = DynamicsFile> {
    use IntegratorName::*;
    let integrator =
        prop::sample::select(vec![Bdf2, ImplicitEuler, GeneralizedAlpha, Midpoint, Sdirk4, TrBdf2]);
    let number = || prop::option::of(positive());
    (
        prop::option::of(integrator),
        [number(), number(), number(), number(), number(), number()],
        prop::option::of(0..9_usize),
        prop::option::of(word()),
    )
        .prop_map(
            |(
                integrator,
                [time_step, tolerance, duration, output_rate, spectral_radius, mass_damping],
                newton_iterations,
                start,
            )| DynamicsFile {
                integrator,
                spectral_radius,
                time_step,
                tolerance,
                newton_iterations,
                mass_damping,
                duration,
                output_rate,
                start,
            },
        )
}

fn tissue() -> impl Strategy<Value = TissueFile> {
    (number(), number(), [positive(), positive()].map(prop::option::of)).prop_map(
        |(pierced_by, stiffness, [friction, grip])| TissueFile { pierced_by, stiffness, friction, grip },
    )
}

fn eyelet() -> impl Strategy<Value = EyeletFile> {
    let numbers = [positive(), positive(), positive()].map(prop::option::of);
    (word(), place(), prop::option::of(vector()), prop::option::of(word()), numbers).prop_map(
        |(rod, at, position, body, [stiffness, friction, grip])| EyeletFile {
            rod,
            at,
            position,
            body,
            stiffness,
            friction,
            grip,
        },
    )
}

fn obstacle() -> impl Strategy<Value = ObstacleFile> {
    let shape = prop::sample::select(vec![
        ObstacleName::Plane,
        ObstacleName::Sphere,
        ObstacleName::Capsule,
        ObstacleName::Cylinder,
        ObstacleName::Box,
        ObstacleName::Ring,
        ObstacleName::Tube,
        ObstacleName::Mesh,
    ]);
    let place = (prop::option::of(vector()), prop::option::of(vector()));
    let turned = prop::option::of([number(), number(), number(), number()]);
    let sizes = [positive(), positive(), positive(), positive(), positive()].map(prop::option::of);
    let mesh = (
        prop::option::of(word()),
        prop::option::of(prop::collection::vec(vector(), 0..4)),
        prop::option::of(prop::collection::vec([0..9_usize, 0..9_usize, 0..9_usize], 0..4)),
    );
    (shape, place, turned, prop::option::of(vector()), sizes, mesh, prop::option::of(tissue())).prop_map(
        |(shape, (position, normal), orientation, size, sizes, (file, corners, triangles), tissue)| {
            let [radius, wire_radius, length, scale, friction] = sizes;
            ObstacleFile {
                shape,
                position,
                normal,
                orientation,
                radius,
                wire_radius,
                length,
                size,
                file,
                scale,
                corners,
                triangles,
                friction,
                tissue,
            }
        },
    )
}

fn scene() -> impl Strategy<Value = SceneFile> {
    (
        word(),
        prop::option::of(vector()),
        prop::collection::vec((word(), material()), 0..3),
        prop::collection::vec((word(), rod()), 0..3),
        (prop::collection::vec(body(), 0..3), prop::collection::vec(joint(), 0..3)),
        (prop::option::of(coupling()), prop::option::of(solver()), prop::option::of(dynamics())),
        (
            prop::option::of(vector()),
            prop::option::of(prop::option::of(positive())),
            prop::collection::vec(obstacle(), 0..3),
            prop::collection::vec(eyelet(), 0..3),
        ),
    )
        .prop_map(
            |(
                name,
                gravity,
                materials,
                rods,
                (bodies, joints),
                (coupling, solver, dynamics),
                (wind, contact, obstacles, eyelets),
            )| SceneFile {
                format: 1,
                name,
                gravity,
                materials: IndexMap::from_iter(materials),
                rods: IndexMap::from_iter(rods),
                bodies,
                joints,
                coupling,
                wind: wind.map(|velocity| WindFile { velocity }),
                contact: contact.map(|friction| ContactFile { friction }),
                obstacles,
                eyelets,
                solver,
                dynamics,
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_scene_written_as_toml_or_json_reads_back_as_the_same_scene(scene in scene()) {
        prop_assert_eq!(&SceneFile::parse(&scene.to_toml(), "scene.toml").unwrap(), &scene);
        prop_assert_eq!(&SceneFile::parse(&scene.to_json(), "scene.json").unwrap(), &scene);
    }

    #[test]
    fn any_text_is_a_scene_or_an_error_but_never_a_panic(text in ".{0,200}") {
        for name in ["scene.toml", "scene.json"] {
            if let Err(error) = Scene::parse(&text, name, None) {
                prop_assert!(!error.render(true).is_empty());
                prop_assert!(error.line() > 0);
            }
        }
    }
}

#[test]
fn the_schema_is_what_it_was() {
    assert!(!schema().to_string().contains("\"null\""));
    insta::assert_json_snapshot!(schema());
}

#[test]
fn every_key_of_every_bundled_scene_survives_both_forms() {
    for scene in bundled() {
        let read = Scene::parse(scene.text, scene.name, None).unwrap().file;
        assert_eq!(Scene::parse(&read.to_toml(), "scene.toml", None).unwrap().file, read);
        assert_eq!(Scene::parse(&read.to_json(), "scene.json", None).unwrap().file, read);
    }
}
