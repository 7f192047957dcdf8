//! What holds a rod and what acts on it, as written: supports, loads, the hand.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserializer, Visitor};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;
use strands::coupling::VirtualCoupling;
use thiserror::Error;

/// A place on a rod: `"start"`, `"end"`, or metres of rest length from the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// `s = 0`.
    Start,
    /// `s = L`.
    End,
    /// Metres from the start.
    At(f64),
}

/// A support.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct SupportFile {
    /// Where.
    pub at: Place,
    /// What it holds.
    pub fix: Vec<FixName>,
    /// Where it holds, m. Default: where the unloaded rod has this place, or its `initial` shape if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// The frame it holds, a unit quaternion `[w, x, y, z]`. Default: as the unloaded rod has it, or its `initial` shape if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<[f64; 4]>,
    /// A direction in world axes along which it lets the rod slide, though it holds the position otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slide_along: Option<[f64; 3]>,
    /// An axis in world directions about which it lets the rod turn, though it holds the orientation otherwise: a hinge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn_about: Option<[f64; 3]>,
    /// How it moves in a simulation: keyframes at growing times, between them along a straight line and by the shortest turn, before the first and
    /// after the last at rest. A static solve has it where it is at `t = 0`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub motion: Vec<KeyframeFile>,
}

/// Where a support is at a time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a keyframe, as { t = 0.5, position = [0.0, 0.0, 0.1] }")]
pub struct KeyframeFile {
    /// When, s.
    pub t: f64,
    /// Where it then holds, m. Default: the support's own `position`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// The frame that it then holds, a unit quaternion `[w, x, y, z]`. Default: the support's own `orientation`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<[f64; 4]>,
}

/// What a support holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FixName {
    /// The position along the world's x.
    X,
    /// The position along the world's y.
    Y,
    /// The position along the world's z.
    Z,
    /// `x`, `y` and `z`.
    Position,
    /// `tangent` and `twist`.
    Orientation,
    /// The direction of d3.
    Tangent,
    /// The turn about d3.
    Twist,
}

/// A load: at a point (`at` with `force`, `moment`) or along a stretch (`from`, `to` with `force_per_length`, `moment_per_length`); or a pull towards a
/// point that stays where it is (`towards` with `tension` or `tension_per_length`), as of a guy wire under constant tension.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct LoadFile {
    /// Where it acts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Place>,
    /// Where the stretch starts. Default "start".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Place>,
    /// Where the stretch ends. Default "end".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Place>,
    /// Force, N.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<[f64; 3]>,
    /// Moment, N·m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment: Option<[f64; 3]>,
    /// Force per unit length, N/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_per_length: Option<[f64; 3]>,
    /// Moment per unit length, N.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment_per_length: Option<[f64; 3]>,
    /// The point that it pulls towards wherever the rod moves, m, world axes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub towards: Option<[f64; 3]>,
    /// How hard it pulls towards the point, N. Negative pushes away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tension: Option<f64>,
    /// The same per unit length, N/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tension_per_length: Option<f64>,
    /// The frame in which it is given and keeps its direction. Default "world".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<FrameName>,
}

/// The frame in which a load keeps its direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FrameName {
    /// A dead load.
    World,
    /// A follower load.
    Body,
}

/// Virtual couplings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct CouplingFile {
    /// The hand's.
    pub hand: HandFile,
}

/// A hand that holds a rod's end through a spring and damper. It acts where someone moves the hand; a static solve of the scene
/// holds the rod by its supports alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct HandFile {
    /// The name of the rod that it holds.
    pub rod: String,
    /// Where it holds it. Default and only place so far: "end".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Place>,
    /// Stiffness against shifts, N/m.
    pub linear_stiffness: f64,
    /// Stiffness against turns, N·m/rad.
    pub angular_stiffness: f64,
    /// Damping of shifts, N·s/m. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub linear_damping: Option<f64>,
    /// Damping of turns, N·m·s/rad. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angular_damping: Option<f64>,
    /// The largest force that the device gives, N. Default: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_force: Option<f64>,
    /// The largest torque that the device gives, N·m. Default: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_torque: Option<f64>,
}

impl Place {
    /// Metres from the start of a rod of a length.
    pub fn metres(self, length: f64) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::End => length,
            Self::At(s) => s,
        }
    }

    /// Whether this is the end of a rod of a length, however it is written.
    pub fn is_end(self, length: f64) -> bool {
        (self.metres(length) - length).abs() <= 1e-9 * length
    }
}

/// A number of a hand that cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{key} {must}, but is {value}")]
pub struct HandError {
    /// Its key in [`HandFile`].
    pub key: &'static str,
    /// Its value.
    pub value: f64,
    /// What it must be.
    pub must: &'static str,
}

impl HandFile {
    /// The coupling by which it holds the rod.
    ///
    /// # Errors
    /// The first number that cannot be: a stiffness or a limit that is not greater than zero, a damping that is negative, one that is not
    /// finite.
    pub fn coupling(&self) -> Result<VirtualCoupling, HandError> {
        let checked = |key, value: f64, met: bool, must| {
            let must = if value.is_finite() { must } else { "must be a finite number" };
            if met && value.is_finite() { Ok(value) } else { Err(HandError { key, value, must }) }
        };
        let positive = |key, value| checked(key, value, value > 0.0, "must be greater than zero");
        let damping = |key, value: Option<f64>| {
            let value = value.unwrap_or(0.0);
            checked(key, value, value >= 0.0, "must not be negative")
        };
        let limit = |key, value: Option<f64>| value.map_or(Ok(f64::INFINITY), |value| positive(key, value));
        Ok(VirtualCoupling {
            linear_stiffness: positive("linear_stiffness", self.linear_stiffness)?,
            angular_stiffness: positive("angular_stiffness", self.angular_stiffness)?,
            linear_damping: damping("linear_damping", self.linear_damping)?,
            angular_damping: damping("angular_damping", self.angular_damping)?,
            max_force: limit("max_force", self.max_force)?,
            max_torque: limit("max_torque", self.max_torque)?,
        })
    }
}

impl Serialize for Place {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Start => serializer.serialize_str("start"),
            Self::End => serializer.serialize_str("end"),
            Self::At(s) => serializer.serialize_f64(*s),
        }
    }
}

impl<'de> Deserialize<'de> for Place {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct WordOrNumber;
        impl Visitor<'_> for WordOrNumber {
            type Value = Place;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"start\", \"end\", or metres from the rod's start")
            }

            fn visit_str<E: de::Error>(self, word: &str) -> Result<Place, E> {
                match word {
                    "start" => Ok(Place::Start),
                    "end" => Ok(Place::End),
                    _ => Err(E::unknown_variant(word, &["start", "end", "metres from the start"])),
                }
            }

            fn visit_f64<E: de::Error>(self, s: f64) -> Result<Place, E> {
                Ok(Place::At(s))
            }

            fn visit_i64<E: de::Error>(self, s: i64) -> Result<Place, E> {
                Ok(Place::At(s as f64))
            }

            fn visit_u64<E: de::Error>(self, s: u64) -> Result<Place, E> {
                Ok(Place::At(s as f64))
            }
        }
        deserializer.deserialize_any(WordOrNumber)
    }
}

impl JsonSchema for Place {
    fn schema_name() -> Cow<'static, str> {
        "Place".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A place on a rod: \"start\", \"end\", or metres of rest length from the start.",
            "anyOf": [{ "enum": ["start", "end"] }, { "type": "number", "minimum": 0 }]
        })
    }
}
