//! What rods pass through, as written: eyelets, and tissue that their ends pierce.

use super::held::Place;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An eyelet, with `[contact]`: a point on springs through which a rod slides with friction, from the start of a simulation on. It does not turn the rod, and has no size
/// of its own: a hole with a rim is an obstacle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct EyeletFile {
    /// The rod.
    pub rod: String,
    /// Where along it the eyelet is at first, m from its start.
    pub at: Place,
    /// Where it is, m, no further than an element from where the rod is there. Default: where the rod is there in its initial shape, or at rest where it has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// The body with which it moves. Default: it stands still.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// How stiff it is, N/m: so much it gives way. Default: 48 times `EI` of the rod over the cube of its mean element, as stiff as an element is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// The coefficient of friction, against what presses the rod to its side. Default that of `[contact]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// How much friction there is beside that, N. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grip: Option<f64>,
}

/// Tissue: the ends of rods pierce it, and the holes hold what goes through them, each a point on springs. What is inside of it meets nothing but the holes. Holes do not go over joints from one rod to the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, as { pierced_by = 0.5, stiffness = 200.0 }")]
pub struct TissueFile {
    /// The force with which an end pierces it, N. An end whose place is held goes in without more ado; coming out takes no force.
    pub pierced_by: f64,
    /// How stiff the edge of a hole is, N/m: so much it gives way.
    pub stiffness: f64,
    /// The coefficient of friction in a hole, against what presses a rod to its side. Default that of `[contact]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// How much friction there is in a hole beside that, N. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grip: Option<f64>,
}
