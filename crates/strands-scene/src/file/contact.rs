//! Contact and obstacles, as written.

use super::passage::TissueFile;
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

/// What stands still and is touched, with `[contact]`. Bodies with a shape are touched too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct ObstacleFile {
    /// Its shape.
    pub shape: ObstacleName,
    /// A point of a plane or of the axis of a tube, the middle of what has an end, where the origin of a mesh is, m. Default the origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// Where a plane's free side is. Default `[0.0, 0.0, 1.0]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<[f64; 3]>,
    /// How it is turned, a unit quaternion `[w, x, y, z]`; what is long lies along its third axis, and a ring is about it. Default the identity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<[f64; 4]>,
    /// Radius of a sphere, a capsule, a cylinder, a tube's inside or the centre line of a ring, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Radius of the wire of a ring, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wire_radius: Option<f64>,
    /// Length of a cylinder, or of a capsule between its two half balls, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Edges of a box along its axes, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[f64; 3]>,
    /// The file of a mesh, `.stl`, `.obj`, `.gltf` or `.glb`, relative to the folder of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// How long a unit of that file is, m. Default 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// The corners of a mesh, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub corners: Option<Vec<[f64; 3]>>,
    /// The numbers of the corners of its triangles, from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub triangles: Option<Vec<[usize; 3]>>,
    /// The coefficient of friction on it. Default that of `[contact]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// What the ends of rods pierce. Default: nothing goes into it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tissue: Option<TissueFile>,
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
    /// A cylinder with flat ends: `position`, `orientation`, `radius`, `length`.
    Cylinder,
    /// A box: `position`, `orientation`, `size`.
    Box,
    /// A ring of round wire, an eyelet: `position`, `orientation`, `radius`, `wire_radius`.
    Ring,
    /// The inside of a tube without end: `position`, `orientation`, `radius`.
    Tube,
    /// A surface of triangles, touched from either side: `file` with `scale`, or `corners` and `triangles`; `position`, `orientation`.
    Mesh,
}
