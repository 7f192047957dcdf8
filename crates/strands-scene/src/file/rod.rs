//! A rod as written: its section or stiffness, its rest shape, its mesh.

use super::held::{LoadFile, SupportFile};
use schemars::JsonSchema;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A rod.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct RodFile {
    /// The name of its material. Not with `stiffness`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Rest length, m. It may be left out where `rest` or `initial` gives points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// How many elements it is cut into. Default 100; not with `tolerance`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<usize>,
    /// The relative error that the mesh is chosen for, in place of `elements`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Its cross-section, or a list of them at growing `s` with linear change between.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub section: Option<SectionsFile>,
    /// Which strains are free. Default "cosserat".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinematics: Option<KinematicsName>,
    /// Stiffness given directly, in place of `material` and `section`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<StiffnessFile>,
    /// Mass per unit length, kg/m; with `stiffness` only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_per_length: Option<f64>,
    /// Rotational inertia per unit length about d1, d2, d3, kg·m; with `stiffness` only. It has no effect on a static solve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotational_inertia_per_length: Option<[f64; 3]>,
    /// Its shape when nothing acts on it. Default straight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rest: Option<RestFile>,
    /// Where it starts, m. Default the origin, or the first of the rest shape's points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// Its frame there, a unit quaternion `[w, x, y, z]`; the identity lies along +z. Default the identity, or along the rest shape's
    /// points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<[f64; 4]>,
    /// The shape that motion starts from, with `start = "initial"` in `[dynamics]`, where that is not the rest shape: a knot in a thread that is straight at
    /// rest. What supports hold, they then hold there, unless they say where.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial: Option<InitialFile>,
    /// What holds it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub supports: Vec<SupportFile>,
    /// What acts on it besides gravity.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<LoadFile>,
    /// What slows it down in a simulation: the drag of the medium around. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drag: Option<DragFile>,
    /// How its inertia is summed onto its nodes in a simulation. Default "lumped".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_matrix: Option<MassMatrixName>,
}

/// How the inertia of a rod is summed onto its nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MassMatrixName {
    /// Each node carries that of half of each element beside it.
    Lumped,
    /// That of velocities that are linear along each element, which couples neighbours.
    Consistent,
}

/// The drag of the medium around a rod, per unit length.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct DragFile {
    /// Force over length and speed through the medium, N·s/m². Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub linear: Option<f64>,
    /// Force over length and the square of the speed across the rod, N·s²/m³: half of density, drag coefficient and diameter. It acts across
    /// the rod. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quadratic: Option<f64>,
}

/// Which strains are free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum KinematicsName {
    /// All six: bending, twist, stretch and shear.
    Cosserat,
    /// Bending and twist only: inextensible and unshearable.
    Kirchhoff,
}

/// One section for the whole rod, or stations along it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum SectionsFile {
    /// The same everywhere.
    One(SectionFile),
    /// Stations at growing `s`, the first at 0; two at the same `s` make a step.
    Stations(Vec<SectionFile>),
}

/// A cross-section, its axes along d1 and d2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a section, as { shape = \"circle\", radius = 1e-3 }")]
pub struct SectionFile {
    /// Where, m; in a list of stations only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub s: Option<f64>,
    /// Its shape.
    pub shape: ShapeName,
    /// Radius of a circle, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Outer radius of an annulus, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outer_radius: Option<f64>,
    /// Inner radius of an annulus, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inner_radius: Option<f64>,
    /// Half axis of an ellipse along d1, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub a: Option<f64>,
    /// Half axis of an ellipse along d2, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub b: Option<f64>,
    /// Side of a rectangle along d1, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
    /// Side of a rectangle along d2, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// Another material than the rod's from this station on; in a list of stations only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
}

/// The shape of a cross-section.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ShapeName {
    /// A full circle: `radius`.
    Circle,
    /// A tube: `outer_radius`, `inner_radius`.
    Annulus,
    /// A full ellipse: `a`, `b`.
    Ellipse,
    /// A full rectangle: `width`, `height`.
    Rectangle,
}

/// Stiffness of a rod: its diagonal, or a full matrix.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct StiffnessFile {
    /// Bending stiffness about d1 and d2, EI1 and EI2, N·m².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bending: Option<[f64; 2]>,
    /// Torsional stiffness GJ, N·m².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torsion: Option<f64>,
    /// Axial stiffness EA, N. A Kirchhoff rod does without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axial: Option<f64>,
    /// Shear stiffness along d1 and d2, N. A Kirchhoff rod does without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear: Option<[f64; 2]>,
    /// A symmetric positive definite matrix in place of all that: rows and columns κ1, κ2, τ, v1, v2, v3.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub matrix: Option<[[f64; 6]; 6]>,
}

/// The shape of a rod when nothing acts on it, given in one of five ways.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct RestFile {
    /// The same curvature and twist `[κ1, κ2, τ]` everywhere, 1/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curvature: Option<[f64; 3]>,
    /// Curvature and twist at growing `s`, linear between, constant beyond; two at the same `s` make a jump.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<Vec<RestSample>>,
    /// A helix.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub helix: Option<HelixFile>,
    /// Points in the world, m, that the rod runs through without twist.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<Vec<[f64; 3]>>,
    /// A CSV file, its path relative to the scene's: columns `x,y,z` are points, `s,kappa1,kappa2,tau` are samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub csv: Option<String>,
}

/// The shape that motion starts from, given in one of three ways. Its length is the rod's.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct InitialFile {
    /// Points in the world, m, that the rod runs through smoothly. The frame at the first is the rod's `orientation`, turned by the least to lie along them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<Vec<[f64; 3]>>,
    /// A CSV file of such points, its path relative to the scene's, with the columns `x,y,z`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub csv: Option<String>,
    /// A helix from the rod's `position` and `orientation` on, as that of a rest shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub helix: Option<HelixFile>,
    /// How far its frames turn about the rod as one goes along it, 1/m, beside those that are carried along without turning. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub twist: Option<f64>,
}

/// Rest curvature and twist at a place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a sample, as { s = 0.0, curvature = [0.0, 8.0, 0.0] }")]
pub struct RestSample {
    /// Where, m.
    pub s: f64,
    /// Curvature and twist `[κ1, κ2, τ]` there, 1/m.
    pub curvature: [f64; 3],
}

/// A helical rest shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a helix, as { radius = 6e-3, pitch = 6e-3 }")]
pub struct HelixFile {
    /// Radius of the centre line, m.
    pub radius: f64,
    /// Rise in one turn, m; negative for a left-handed helix.
    pub pitch: f64,
}

impl<'de> Deserialize<'de> for SectionsFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrList;
        impl<'de> Visitor<'de> for OneOrList {
            type Value = SectionsFile;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a section, as { shape = \"circle\", radius = 1e-3 }, or a list of them")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                Deserialize::deserialize(MapAccessDeserializer::new(map)).map(SectionsFile::One)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Self::Value, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(SectionsFile::Stations)
            }
        }
        deserializer.deserialize_any(OneOrList)
    }
}
