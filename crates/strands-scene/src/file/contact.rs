//! Contact and obstacles, as written.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Contact: rods touch themselves, each other and the obstacles in a simulation. Without it all passes through all. A static solve knows no contact: it has no effect on
/// it. What is not round touches as if it were, with the larger of its half extents for a radius.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct ContactFile {
    /// Coulomb's coefficient of friction. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
}

/// What stands still and is touched, with `[contact]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct ObstacleFile {
    /// Its shape.
    pub shape: ObstacleName,
    /// A point of a plane, the middle of a sphere or a capsule, m. Default the origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// Where a plane's free side is. Default `[0.0, 0.0, 1.0]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<[f64; 3]>,
    /// How a capsule lies along its third axis, a unit quaternion `[w, x, y, z]`. Default the identity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<[f64; 4]>,
    /// Radius of a sphere or a capsule, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Length of a capsule between its two half balls, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// The coefficient of friction on it. Default that of `[contact]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
}

/// Which shape an obstacle has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ObstacleName {
    /// All behind a plane: `position`, `normal`.
    Plane,
    /// A sphere: `position`, `radius`.
    Sphere,
    /// A cylinder between two half balls: `position`, `orientation`, `radius`, `length`.
    Capsule,
}
