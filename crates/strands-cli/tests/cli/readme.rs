//! What the README shows is what happens.

fn readme() -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md");
    std::fs::read_to_string(path).expect("README.md")
}

/// The first block of a language.
fn block<'a>(text: &'a str, language: &str) -> &'a str {
    let (_, rest) = text.split_once(&format!("```{language}\n")).expect("the block");
    rest.split_once("```").expect("its end").0
}

#[test]
fn the_scene_has_the_answer_that_is_shown() {
    let readme = readme();
    let run = crate::common::strands_with(&["solve", "-"], block(&readme, "toml"));
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    // What differs from machine to machine stands on the line of the solver.
    let kept = |text: &str| -> Vec<String> {
        text.lines()
            .filter(|line| !line.starts_with("  solver"))
            .map(|line| line.trim_end().to_owned())
            .collect()
    };
    assert_eq!(kept(&run.out), kept(block(&readme, "text")));
}

#[test]
fn the_path_reaches_its_end() {
    let readme = readme();
    let (_, rest) = readme.split_once("`strands solve thread.toml --path '").expect("the command");
    let (path, _) = rest.split_once('\'').expect("its end");
    let run = crate::common::strands_with(&["solve", "-", "--path", path], block(&readme, "toml"));
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{}", run.out);
    assert!(run.out.contains("the path reaches its end"), "{}", run.out);
}

#[test]
fn the_code_is_this_code() {
    let here = include_str!("readme.rs");
    let (_, rest) = here.split_once("    // The README shows from here\n").expect("the start");
    let (code, _) = rest.split_once("    // to here.\n").expect("the end");
    let code: String =
        code.lines().map(|line| format!("{}\n", line.strip_prefix("    ").unwrap_or(line))).collect();
    assert_eq!(block(&readme(), "rust"), code);
}

#[test]
fn the_code_runs() -> Result<(), Box<dyn std::error::Error>> {
    // The README shows from here
    use std::f64::consts::FRAC_PI_2;
    use strands::load::NodalLoads;
    use strands::math::{Pose, Vec3, Vec6};
    use strands::rod::{
        Kinematics, Material, Order, Profile, RestShape, Rod, RodDescription, Section, Station,
    };
    use strands::statics::{Problem, Settings, Support, Workspace, solve};

    let nylon = Material::from_poisson(2e9, 0.39, 1140.0)?;
    let round = Section::Circle { radius: 150e-6 };
    let rod = RodDescription {
        length: 0.3,
        kinematics: Kinematics::Kirchhoff,
        profile: Profile::Stations(vec![Station { s: 0.0, section: round, material: nylon }]),
        rest: RestShape::default(),
        base: Pose::IDENTITY,
    };
    let rod = Rod::with_elements(rod, 100, &[], Order::Second)?;
    let weight = NodalLoads::none(&rod).with_gravity(&rod, Vec3::new(0.0, 0.0, -9.81));
    let mut problem = Problem { loads: weight, ..Problem::cantilever(rod) };

    // Hold the end in a hand: 100 mm aside, 200 mm up, turned by a right angle.
    let turned = Pose::exp(Vec6::new(Vec3::Y * FRAC_PI_2, Vec3::ZERO));
    problem.end = Support::clamped(Pose { position: Vec3::new(0.1, 0.0, 0.2), ..turned });

    let solution = solve(&problem, &Settings::default(), None, &mut Workspace::default())?;
    let hand = solution.end_reaction();
    println!("force {:?} N, moment {:?} N·m", hand.force, hand.moment);
    // to here.
    assert!(solution.imbalance(&problem) < 1e-9);
    Ok(())
}
