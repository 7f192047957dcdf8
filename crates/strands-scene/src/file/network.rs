//! Rigid bodies, and joints between rods and bodies, as written.

use super::held::{FixName, KeyframeFile, Place, SupportFile};
use super::passage::TissueFile;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rigid body: a needle, a weight, a gripper. It is given by a `shape` of a `density`, or by `mass` and `inertia`. Gravity acts on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct BodyFile {
    /// Its name, by which joints know it.
    pub name: String,
    /// Its shape, solid, its centre of mass in the middle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<BodyShapeFile>,
    /// Density, kg/m³; with `shape` only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Mass, kg, in place of `shape` and `density`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Moments of inertia about its own three axes, its principal axes, through the centre of mass, kg·m²; with `mass`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<[f64; 3]>,
    /// Where its centre of mass is at rest, m. Default the origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// How its axes then lie, a unit quaternion `[w, x, y, z]`. Default the identity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<[f64; 4]>,
    /// How fast it sets off, m/s, in world axes, where the simulation starts from "rest". Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<[f64; 3]>,
    /// How fast it then turns, rad/s, in world axes. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angular_velocity: Option<[f64; 3]>,
    /// What the ends of rods pierce; with `shape`. Default: nothing goes into it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tissue: Option<TissueFile>,
    /// What holds it at its centre of mass. Default: nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub support: Option<BodySupportFile>,
}

/// The shape of a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a shape, as { shape = \"ball\", radius = 5e-3 }")]
pub struct BodyShapeFile {
    /// Which.
    pub shape: BodyShapeName,
    /// Radius of a ball, a capsule, a cylinder or the centre line of a ring, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Radius of the wire of a ring, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wire_radius: Option<f64>,
    /// Length of a cylinder, m; of a capsule that of the cylinder between its two half balls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// The edges of a block along its own axes, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[f64; 3]>,
}

/// Which shape a body has. What is long lies along its third axis, as a rod does, and a ring is about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BodyShapeName {
    /// A ball: `radius`.
    Ball,
    /// A cylinder between two half balls: `radius`, `length`.
    Capsule,
    /// A cylinder: `radius`, `length`.
    Cylinder,
    /// A block: `size`.
    Block,
    /// A ring of round wire, an eyelet: `radius`, `wire_radius`.
    Ring,
}

/// A support of a body, at its centre of mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a support, as { fix = [\"position\", \"orientation\"] }")]
pub struct BodySupportFile {
    /// What it holds.
    pub fix: Vec<FixName>,
    /// Where it holds, m. Default: where the body is at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// The frame it holds, a unit quaternion `[w, x, y, z]`. Default: as the body lies at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<[f64; 4]>,
    /// A direction in world axes along which it lets the body slide, though it holds the position otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slide_along: Option<[f64; 3]>,
    /// An axis in world directions about which it lets the body turn, though it holds the orientation otherwise: a hinge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn_about: Option<[f64; 3]>,
    /// How it moves in a simulation: keyframes at growing times, between them along a straight line and by the shortest turn, before the first and
    /// after the last at rest.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub motion: Vec<KeyframeFile>,
}

/// A joint of two places, as they are at rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct JointFile {
    /// What it leaves free.
    pub kind: JointName,
    /// The two that it ties together: places of rods, which have to be one place at rest, and bodies.
    pub between: [JointEndFile; 2],
    /// Where it is, m; between two bodies only. Else it is at the rod's place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// What a hinge turns about, in world directions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
}

/// What a joint leaves free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JointName {
    /// Nothing.
    Rigid,
    /// All turns.
    Ball,
    /// The turn about one axis: `axis`.
    Hinge,
}

/// What a joint ties: a place of a rod, `rod` and `at`, or a `body`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(
    deny_unknown_fields,
    expecting = "a place of a rod, as { rod = \"thread\", at = \"end\" }, or a body, as { body = \"needle\" }"
)]
pub struct JointEndFile {
    /// The rod's name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rod: Option<String>,
    /// Where along the rod.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Place>,
    /// The body's name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
}

impl SupportFile {
    /// The same without its place.
    pub(crate) fn without_place(&self) -> BodySupportFile {
        let Self { at: _, fix, position, orientation, slide_along, turn_about, motion } = self.clone();
        BodySupportFile { fix, position, orientation, slide_along, turn_about, motion }
    }
}
