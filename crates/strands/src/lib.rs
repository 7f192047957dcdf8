//! Thin elastic solids that bend, twist, stretch and shear: sutures, catheters, hair, ropes, cables, vines.
//!
//! A rod is a curve of frames, `H(s) = (R, p)`, with directors `d1 d2 d3` as the columns of `R` and `d3` along the curve at rest (Cosserat
//! rods; D. K. Pai, *STRANDS: Interactive Simulation of Thin Solids using Cosserat Models*, 2002). Its strain `ε = (u, v)` says how the frame
//! moves along the rod, `H' = H ε^`; its law gives the stress `σ = (m, n)` of the strain beyond the rest strain; and an equilibrium is a shape whose
//! stress balances the loads. All quantities are in SI units.
//!
//! # A solve
//!
//! A suture, clamped at one end, pulled and twisted at the other:
//!
//! ```
//! use strands::load::{Frame, NodalLoads, PointLoad};
//! use strands::math::{Pose, Vec3, Wrench};
//! use strands::rod::{Kinematics, Material, Order, Profile, RestShape, Rod, RodDescription, Section, Station};
//! use strands::statics::{Problem, Settings, Workspace, solve};
//!
//! let polypropylene = Material::from_poisson(1.5e9, 0.4, 910.0)?;
//! let section = Section::Circle { radius: 75e-6 };
//! let description = RodDescription {
//!     length: 0.1,
//!     kinematics: Kinematics::Kirchhoff,
//!     profile: Profile::Stations(vec![Station { s: 0.0, section, material: polypropylene }]),
//!     rest: RestShape::default(),
//!     base: Pose::IDENTITY,
//! };
//! let rod = Rod::with_elements(description, 100, &[], Order::Second)?;
//! let pull = PointLoad {
//!     at: 0.1,
//!     wrench: Wrench::new(Vec3::new(0.0, 0.0, 1e-7), Vec3::new(5e-6, 0.0, 1e-6)),
//!     frame: Frame::World,
//! };
//! let loads = NodalLoads::none(&rod).with_point(&rod, &pull)?;
//! let problem = Problem { loads, ..Problem::cantilever(rod) };
//!
//! let solution = solve(&problem, &Settings::default(), None, &mut Workspace::default())?;
//! assert!(solution.imbalance(&problem) < 1e-12);
//! println!("the tip is at {:?} m", solution.poses[100].position);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What is where
//!
//! | module | idea |
//! | --- | --- |
//! | [`math`] | vectors, poses in SE(3), their exponential and tangent; one kernel for one rod or several in SIMD lanes |
//! | [`rod`] | what a rod is: material, section, law, rest shape, mesh |
//! | [`load`] | what acts on it |
//! | `element` | the mechanics of one element, written once |
//! | [`statics`] | equilibrium: sweeps, shooting, ways to afar, stability, meshes for a tolerance |
//! | [`assembly`] | several rods, rigid bodies, and the joints between them |
//! | [`dynamics`] | motion: inertia, integrators, damping, energy |
//! | [`contact`] | surfaces that touch |
//! | [`coupling`] | the hand that holds a strand: a virtual coupling |
//!
//! The crate does no I/O and starts no threads, and builds for WebAssembly.

pub mod assembly;
pub mod contact;
pub mod coupling;
pub mod dynamics;
mod element;
pub mod load;
pub mod math;
pub mod rod;
pub mod statics;
