//! A scene as it is written: the types of the file format, of which the JSON Schema is made.
//!
//! SI units throughout; positions `[x, y, z]` and quaternions `[w, x, y, z]` in the world frame; `s` in metres of rest length from the
//! rod's start. Nothing here is checked beyond its type: that is done when the [`Model`](crate::Model) is built.

mod contact;
mod held;
mod network;
mod passage;
mod rod;
mod settings;

pub use contact::{ContactFile, ObstacleFile, ObstacleName};
pub use held::{
    CouplingFile, FixName, FrameName, HandError, HandFile, KeyframeFile, LoadFile, Place, SupportFile,
};
pub use network::{
    BodyFile, BodyShapeFile, BodyShapeName, BodySupportFile, JointEndFile, JointFile, JointName,
};
pub use passage::{EyeletFile, TissueFile};
pub use rod::{
    DragFile, HelixFile, InitialFile, KinematicsName, MassMatrixName, RestFile, RestSample, RodFile,
    SectionFile, SectionsFile, ShapeName, StiffnessFile,
};
pub use settings::{
    DynamicsFile, IntegratorName, JacobianName, MethodName, SchemeName, SolverFile, WindFile,
};

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A scene file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(title = "Strands scene")]
pub struct SceneFile {
    /// The version of the format: 1.
    #[schemars(range(min = 1, max = 1))]
    pub format: i64,
    /// The scene's name.
    pub name: String,
    /// Acceleration of gravity in the world frame, m/s². Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<[f64; 3]>,
    /// Materials by name.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub materials: IndexMap<String, MaterialFile>,
    /// Rods by name; at least one.
    pub rods: IndexMap<String, RodFile>,
    /// Rigid bodies. They have no effect on a static solve.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<BodyFile>,
    /// What ties rods to each other and to bodies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<JointFile>,
    /// How a hand holds a rod.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coupling: Option<CouplingFile>,
    /// How the medium around moves. It acts on rods that have `drag`, and has no effect on a static solve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wind: Option<WindFile>,
    /// Contact of rods with themselves, each other and obstacles. A static solve knows no contact: it has no effect on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<ContactFile>,
    /// What stands still and is touched, with `[contact]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<ObstacleFile>,
    /// What rods slide through in a simulation, with `[contact]`. They have no effect on a static solve.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub eyelets: Vec<EyeletFile>,
    /// How to solve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solver: Option<SolverFile>,
    /// How to simulate motion. It has no effect on a static solve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dynamics: Option<DynamicsFile>,
}

/// What rods are made of: an isotropic elastic material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct MaterialFile {
    /// Young's modulus E, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio ν, more than -1 and at most 0.5. Give this or `shear_modulus`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub poisson_ratio: Option<f64>,
    /// Shear modulus G, Pa. Give this or `poisson_ratio`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear_modulus: Option<f64>,
    /// Density ρ, kg/m³.
    pub density: f64,
    /// Kelvin–Voigt damping time, s. It has no effect on a static solve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<f64>,
}

impl SceneFile {
    /// The scene as TOML.
    pub fn to_toml(&self) -> String {
        toml::to_string_pretty(self)
            .unwrap_or_else(|error| unreachable!("every scene has a form in TOML: {error}"))
    }

    /// The scene as JSON.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self)
            .unwrap_or_else(|error| unreachable!("every scene has a form in JSON: {error}"))
    }
}
