//! The arguments, as typed.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

/// Interactive simulation of thin elastic solids: sutures, wires, cables, hair.
#[derive(Debug, Parser)]
#[command(name = "strands", version, disable_help_subcommand = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Find the equilibrium of a scene
    Solve(Solve),
    /// Let a scene move in time
    Simulate(Simulate),
    /// Say how hard a scene is, and what looks wrong with it
    Check(Check),
    /// Show a scene in the browser, to hold in the hand
    View(View),
    /// Write a new scene file, with comments
    New(New),
    /// Print the JSON Schema of scene files
    Schema,
    /// Solve problems with known answers, and compare
    Validate(Validate),
    /// Measure what the solvers cost on this machine
    #[command(after_help = crate::bench::NAMES)]
    Bench {
        /// Print one JSON object: {"figures": [{"name", "value", "unit"}]}
        #[arg(long)]
        json: bool,
        /// Count instructions in place of time (needs valgrind)
        #[arg(long)]
        instructions: bool,
        /// Only run a kernel, for the counts
        #[arg(long, hide = true, requires = "times")]
        kernel: Option<String>,
        /// How often
        #[arg(long, hide = true)]
        times: Option<usize>,
    },
    /// Print the completions for a shell
    Completions {
        /// Which shell
        shell: Shell,
    },
}

/// Which solver.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum MethodName {
    /// The one that fits
    Auto,
    /// Two sweeps: one end clamped, the wrench at the other given
    Sweep,
    /// A search for what is unknown at the end
    Shooting,
    /// The same at several places along the rod at once
    #[value(name = "multiple_shooting", alias = "multiple-shooting")]
    MultipleShooting,
    /// All frames at once, moving to where the rod rests
    Equilibrium,
}

/// `strands solve`.
#[derive(Debug, Args)]
#[command(after_help = "Exit status: 0 solved, 1 bad scene or arguments, 2 no equilibrium found.")]
pub struct Solve {
    /// A scene file (.toml or .json), `-` for standard input, or the bare name of a bundled scene
    pub scene: String,
    /// Write the result, in the format of the ending: .json .csv .vtp .glb .svg; may be repeated
    #[arg(short, long, value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Print one JSON object and nothing else
    #[arg(long)]
    pub json: bool,
    /// Search for all equilibria of the rod, stable and unstable, and list them by energy
    #[arg(long, conflicts_with = "path", group = "many")]
    pub all: bool,
    /// How hard --all searches: so many times as many starts and paths
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, requires = "all")]
    pub effort: f64,
    /// Follow the equilibrium while a key of the scene changes from value to value, round folds and past bifurcations, such as
    /// `rods.column.loads[0].force=[0,0,0]..[0,0,-5]`
    #[arg(long, value_name = "KEY=FROM..TO", group = "many")]
    pub path: Option<String>,
    /// Go over to the other branch at this bifurcation of the path, counted from 1
    #[arg(long, value_name = "N", requires = "path", value_parser = clap::value_parser!(u32).range(1..))]
    pub switch: Option<u32>,
    /// The rod that --all or --path is for, where the scene has several
    #[arg(long, value_name = "NAME", requires = "many")]
    pub rod: Option<String>,
    #[command(flatten)]
    pub overrides: Overrides,
}

/// `strands simulate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Rods move on the mesh of the scene, tied as its joints say. The scene's [dynamics] says how, and what it leaves out is: integrator bdf2 (with tolerance
sdirk4, or tr_bdf2 where a rod does not stretch), time_step 1e-3 s, duration 1 s, output_rate 60 frames a second, start in equilibrium.
`--set dynamics.time_step=5e-4` changes any of them.

A .pvd comes with a folder beside it, a .vtp a frame and rod. In .glb and .usda the rods move when they are played.

Exit status: 0 finished, 1 bad scene or arguments, 2 a step could not be made, 130 ended by Ctrl-C; what was simulated until then is written all the
same. A second Ctrl-C ends it at once.")]
pub struct Simulate {
    /// A scene file (.toml or .json), `-` for standard input, or the bare name of a bundled scene
    pub scene: String,
    /// How long to simulate, s
    #[arg(long, value_name = "S")]
    pub seconds: Option<f64>,
    /// How far frames are apart, s
    #[arg(long, value_name = "S")]
    pub every: Option<f64>,
    /// Write the frames, in the format of the ending: .json .csv .npz .pvd .usda .glb; may be repeated
    #[arg(short, long, value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Write the state at the end, from which `start = "FILE"` goes on to the same bits (with `tolerance`, where a frame was due)
    #[arg(long, value_name = "FILE")]
    pub save: Option<PathBuf>,
    /// Print one JSON object and nothing else
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub overrides: Overrides,
}

/// `strands check`.
#[derive(Debug, Args)]
#[command(after_help = "\
Of each rod: its slenderness; its loads over its stiffness, w L³/EI for weight and distributed forces, P L²/EI
for forces at points, M L/EI for moments (far below 1 it hardly bends; from 100 on, its stiffness hardly
matters); its length over the length ℓ = √(EI/T) over which it bends under its tension T; the solver that
\"auto\" takes first; and the error of its mesh, estimated from two solves. Then warnings, where something is
probably a slip or an answer not to be relied on, and notes.

Exit status: 0 with warnings or without, 1 bad scene or arguments.")]
pub struct Check {
    /// A scene file (.toml or .json), `-` for standard input, or the bare name of a bundled scene
    pub scene: String,
    /// Print one JSON object and nothing else
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub overrides: Overrides,
}

/// Changes to the scene.
#[derive(Debug, Default, Args)]
pub struct Overrides {
    /// Solver, in place of the scene's
    #[arg(long)]
    pub method: Option<MethodName>,
    /// Order of accuracy, in place of the scene's
    #[arg(long, value_parser = ["1", "2", "4"])]
    pub order: Option<String>,
    /// Elements of every rod, in place of the scene's
    #[arg(long, value_name = "N")]
    pub elements: Option<usize>,
    /// Residual at which a solution is accepted, in place of the scene's
    #[arg(long)]
    pub tolerance: Option<f64>,
    /// Change any key of the scene, such as rods.thread.length=0.2; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// `strands view`.
#[derive(Debug, Args)]
pub struct View {
    /// A scene file, `-` for standard input, or the bare name of a bundled scene
    pub scene: Option<String>,
    /// Port on this machine, in place of 7878 or the next free one
    #[arg(long)]
    pub port: Option<u16>,
    /// Only print the address
    #[arg(long)]
    pub no_open: bool,
}

/// `strands new`.
#[derive(Debug, Args)]
pub struct New {
    /// The scene's name; it is written to NAME.toml
    pub name: String,
    /// The bundled scene to start from
    #[arg(long, default_value = "suture")]
    pub template: String,
}

/// `strands validate`.
#[derive(Debug, Args)]
#[command(
    after_help = "Exit status: 0 all within their tolerances, 1 bad arguments, 2 a comparison is out of its tolerance or a case is not solved."
)]
pub struct Validate {
    /// Cases, by their names or parts of them, such as cantilever or bend-45; without any, all
    pub names: Vec<String>,
    /// Print every comparison, in place of the worst of each case
    #[arg(long)]
    pub rows: bool,
    /// Print one JSON object: {"cases", "comparisons", "failed", "seconds", "lines": [{"case", "row", "quantity", "expected", "got",
    /// "error", "tolerance", "ok", …}]}
    #[arg(long)]
    pub json: bool,
    /// Write a report with sources and plots of the error against the number of elements
    #[arg(short, long, value_name = "FILE.html")]
    pub output: Option<PathBuf>,
}
