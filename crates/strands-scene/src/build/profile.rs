//! Stiffness and mass of a rod: sections of materials, or given directly.

use super::Context;
use crate::document::KeyPath;
use crate::error::SceneError;
use crate::file::{KinematicsName, RodFile, SectionFile, SectionsFile, ShapeName, StiffnessFile};
use crate::words;
use strands::math::Vec3;
use strands::rod::{Law, Material, Profile, RodError, Section, Station, Stiffness};

/// A rod that gives a bending stiffness only is drawn with this part of its length as its radius.
const DRAWN_RADIUS: f64 = 1.0 / 200.0;

/// The profile of a rod of a length.
pub(super) fn profile(
    context: &Context,
    path: &KeyPath,
    rod: &RodFile,
    length: f64,
) -> Result<Profile, SceneError> {
    match (&rod.stiffness, &rod.section) {
        (Some(stiffness), None) => given(context, path, rod, stiffness, length),
        (None, Some(sections)) => {
            for (key, written) in [
                ("mass_per_length", rod.mass_per_length.is_some()),
                ("rotational_inertia_per_length", rod.rotational_inertia_per_length.is_some()),
            ] {
                if written {
                    let error =
                        context.document.error(&path.key(key), format!("`{key}` goes with `stiffness` only"));
                    return Err(error.mend("remove it: mass follows from section and density"));
                }
            }
            stations(context, path, rod, sections, length)
        }
        (Some(_), Some(_)) => {
            let error =
                context.document.error(&path.key("stiffness"), "both `section` and `stiffness` are given");
            Err(error.mend("keep `section` with `material`, or `stiffness` alone"))
        }
        (None, None) => {
            let error =
                context.document.error(&path.key("section"), "the rod has neither `section` nor `stiffness`");
            Err(error.mend("add its section, as `section = { shape = \"circle\", radius = 1e-3 }`"))
        }
    }
}

fn stations(
    context: &Context,
    path: &KeyPath,
    rod: &RodFile,
    sections: &SectionsFile,
    length: f64,
) -> Result<Profile, SceneError> {
    let own = rod.material.as_ref().map(|name| material(context, &path.key("material"), name)).transpose()?;
    let no_material = |place: &KeyPath| {
        let mend = match context.materials.keys().next() {
            Some(name) => format!("add `material = \"{name}\"` to the rod"),
            None => "describe one in `[materials.steel]` and add `material = \"steel\"` to the rod".into(),
        };
        context.document.error(&place.key("material"), "the rod has no material").mend(mend)
    };
    let path_of_section = path.key("section");
    let written = match sections {
        SectionsFile::One(written) => {
            for (key, given) in [("s", written.s.is_some()), ("material", written.material.is_some())] {
                if given {
                    let place = path_of_section.key(key);
                    let error =
                        context.document.error(&place, format!("`{key}` belongs to a list of sections"));
                    return Err(
                        error.mend("write `section = [{ s = 0.0, … }, { s = 0.1, … }]`, or remove it")
                    );
                }
            }
            let material = own.ok_or_else(|| no_material(path))?;
            let section = section(context, &path_of_section, written, &material)?;
            return Ok(Profile::Stations(vec![Station { s: 0.0, section, material }]));
        }
        SectionsFile::Stations(written) => written,
    };
    if written.is_empty() {
        let error = context.document.error(&path_of_section, "the list of sections is empty");
        return Err(error.mend("give at least one, as `section = { shape = \"circle\", radius = 1e-3 }`"));
    }
    let mut stations: Vec<Station> = Vec::with_capacity(written.len());
    for (i, written) in written.iter().enumerate() {
        let place = path_of_section.index(i);
        let s = station_place(context, &place, written, length)?;
        let material = match &written.material {
            Some(name) => material(context, &place.key("material"), name)?,
            None => own.ok_or_else(|| no_material(&place))?,
        };
        let station = Station { s, section: section(context, &place, written, &material)?, material };
        if let Some(before) = stations.last() {
            follows(context, &place, before, &station)?;
        }
        stations.push(station);
    }
    Ok(Profile::Stations(stations))
}

fn station_place(
    context: &Context,
    place: &KeyPath,
    written: &SectionFile,
    length: f64,
) -> Result<f64, SceneError> {
    let document = context.document;
    let Some(s) = written.s else {
        let error = document.error(place, "`s` is missing: a section in a list says where it is");
        return Err(error.mend("give it in metres from the rod's start, as `s = 0.1`"));
    };
    document.not_negative(&place.key("s"), s)?;
    if s > length * (1.0 + 1e-9) {
        let error = document.error(
            &place.key("s"),
            format!("the section at s = {s} lies beyond the rod, which is {length} m long"),
        );
        return Err(error.mend(format!("use an s from 0 to {length}")));
    }
    Ok(s)
}

/// Checks that a station may follow another.
fn follows(
    context: &Context,
    place: &KeyPath,
    before: &Station,
    station: &Station,
) -> Result<(), SceneError> {
    let document = context.document;
    let step = format!(
        "for a step at s = {s}, give both sections there: first the old one, then the new one",
        s = station.s
    );
    if station.s < before.s {
        let error = document.error(&place.key("s"), format!("s falls from {} to {}", before.s, station.s));
        return Err(error.mend("order the sections by growing s"));
    }
    if station.s > before.s && before.section.interpolate(&station.section, 0.5).is_none() {
        let (from, to) = (before.section.name(), station.section.name());
        let error = document.error(
            &place.key("shape"),
            format!("the shape cannot change little by little from {from} to {to}"),
        );
        return Err(error.mend(step));
    }
    if station.s > before.s && before.material != station.material {
        let error = document.error(&place.key("material"), "the material cannot change little by little");
        return Err(error.mend(step));
    }
    Ok(())
}

fn material(context: &Context, path: &KeyPath, name: &str) -> Result<Material, SceneError> {
    context.materials.get(name).copied().ok_or_else(|| {
        let mend = if context.materials.is_empty() {
            format!("describe it: `[materials.{name}]` with youngs_modulus, poisson_ratio and density")
        } else {
            words::choices("the materials here", name, context.materials.keys())
        };
        context.document.error(path, format!("there is no material `{name}`")).mend(mend)
    })
}

fn section(
    context: &Context,
    path: &KeyPath,
    written: &SectionFile,
    material: &Material,
) -> Result<Section, SceneError> {
    let document = context.document;
    let sizes = [
        ("radius", written.radius),
        ("outer_radius", written.outer_radius),
        ("inner_radius", written.inner_radius),
        ("a", written.a),
        ("b", written.b),
        ("width", written.width),
        ("height", written.height),
    ];
    let (shape, keys): (_, &[&str]) = match written.shape {
        ShapeName::Circle => ("a circle", &["radius"]),
        ShapeName::Annulus => ("an annulus", &["outer_radius", "inner_radius"]),
        ShapeName::Ellipse => ("an ellipse", &["a", "b"]),
        ShapeName::Rectangle => ("a rectangle", &["width", "height"]),
    };
    let needs = format!("{shape} is given by {}", words::quoted(keys));
    if let Some((key, _)) = sizes.iter().find(|(key, size)| size.is_some() && !keys.contains(key)) {
        return Err(document
            .error(&path.key(key), format!("`{key}` does not belong to {shape}"))
            .mend(needs));
    }
    let size = |key: &str| {
        let written = sizes.iter().find(|(name, _)| *name == key).and_then(|(_, size)| *size);
        let size = written.ok_or_else(|| {
            document.error(&path.key(key), format!("`{key}` is missing")).mend(needs.clone())
        })?;
        if key == "inner_radius" {
            document.not_negative(&path.key(key), size)
        } else {
            document.positive(&path.key(key), size)
        }
    };
    let section = match written.shape {
        ShapeName::Circle => Section::Circle { radius: size("radius")? },
        ShapeName::Annulus => {
            let (outer_radius, inner_radius) = (size("outer_radius")?, size("inner_radius")?);
            if inner_radius >= outer_radius {
                let error = document.error(
                    &path.key("inner_radius"),
                    format!("the hole's radius, {inner_radius}, must be less than the outer radius, {outer_radius}"),
                );
                return Err(error.mend("swap the two, or use a circle"));
            }
            Section::Annulus { outer_radius, inner_radius }
        }
        ShapeName::Ellipse => Section::Ellipse { a: size("a")?, b: size("b")? },
        ShapeName::Rectangle => Section::Rectangle { width: size("width")?, height: size("height")? },
    };
    if section.stiffness(material).validate().is_err() || !(material.density * section.area()).is_finite() {
        let e_i = section.stiffness(material).bending[0];
        let error = document.error(
            path,
            format!("with these sizes and this material the bending stiffness EI is {e_i:e} N·m²"),
        );
        return Err(error.mend("check the units: lengths in m, moduli in Pa, density in kg/m³"));
    }
    Ok(section)
}

fn given(
    context: &Context,
    path: &KeyPath,
    rod: &RodFile,
    stiffness: &StiffnessFile,
    length: f64,
) -> Result<Profile, SceneError> {
    let document = context.document;
    if rod.material.is_some() {
        let error =
            document.error(&path.key("material"), "`stiffness` takes the place of `material` and `section`");
        return Err(error.mend("remove `material`, or give a `section` in place of `stiffness`"));
    }
    let rotational_inertia_per_length = rod.rotational_inertia_per_length.map_or(Vec3::ZERO, Vec3::from);
    for (i, inertia) in rod.rotational_inertia_per_length.iter().flatten().enumerate() {
        document.not_negative(&path.key("rotational_inertia_per_length").index(i), *inertia)?;
    }
    let mass_per_length = match rod.mass_per_length {
        Some(mass) => document.not_negative(&path.key("mass_per_length"), mass)?,
        None if context.gravity == Vec3::ZERO => 0.0,
        None => {
            let error = document.error(
                &path.key("mass_per_length"),
                "there is gravity, but the rod has no `mass_per_length`",
            );
            return Err(
                error.mend("give it in kg/m, as `mass_per_length = 1e-3`; 0 for a rod without weight")
            );
        }
    };
    let table = path.key("stiffness");
    let kirchhoff = rod.kinematics == Some(KinematicsName::Kirchhoff);
    let (law, bending, axial) = match &stiffness.matrix {
        Some(matrix) => {
            let others = [
                ("bending", stiffness.bending.is_some()),
                ("torsion", stiffness.torsion.is_some()),
                ("axial", stiffness.axial.is_some()),
                ("shear", stiffness.shear.is_some()),
            ];
            if let Some((key, _)) = others.iter().find(|(_, given)| *given) {
                let error = document.error(&table.key(key), format!("both `matrix` and `{key}` are given"));
                return Err(error.mend("keep `matrix` alone, or remove it"));
            }
            let place = table.key("matrix");
            let law = Law::full(*matrix).map_err(|error| {
                let (place, message) = match error {
                    RodError::NotSymmetric { row: i, column: j } => (
                        place.index(j).index(i),
                        format!("the stiffness matrix is not symmetric: {} and {} differ", matrix[j][i], matrix[i][j]),
                    ),
                    RodError::NotPositiveDefinite { row } => {
                        (place.index(row), format!("the stiffness matrix is not positive definite: row {} shows it", row + 1))
                    }
                    other => (place.clone(), other.to_string()),
                };
                let error = document.error(&place, message);
                error.mend("rows and columns stand for κ1, κ2, τ, v1, v2, v3; the entry of row i and column j is that of row j and column i")
            })?;
            (law, [matrix[0][0], matrix[1][1]], matrix[5][5])
        }
        None => {
            let diagonal = diagonal(context, &table, stiffness, kirchhoff, length)?;
            (Law::Diagonal(diagonal), diagonal.bending, diagonal.axial)
        }
    };
    // The full ellipse of one material that has these stiffnesses: EI1 = EA b²/4, EI2 = EA a²/4.
    let half_extent = [2.0 * (bending[1] / axial).sqrt(), 2.0 * (bending[0] / axial).sqrt()];
    Ok(Profile::Given { law, mass_per_length, rotational_inertia_per_length, half_extent })
}

fn diagonal(
    context: &Context,
    table: &KeyPath,
    stiffness: &StiffnessFile,
    kirchhoff: bool,
    length: f64,
) -> Result<Stiffness, SceneError> {
    let document = context.document;
    let missing = |key: &str| document.missing(&table.key(key));
    let pair = |key: &str, values: [f64; 2]| {
        let place = table.key(key);
        Ok([document.positive(&place.index(0), values[0])?, document.positive(&place.index(1), values[1])?])
    };
    let bending = pair("bending", stiffness.bending.ok_or_else(|| missing("bending"))?)?;
    let torsion =
        document.positive(&table.key("torsion"), stiffness.torsion.ok_or_else(|| missing("torsion"))?)?;
    // What a Kirchhoff rod does not need only tells how thick it is drawn.
    let unneeded = |given: bool| kirchhoff && !given;
    let drawn = 4.0 * bending[0].max(bending[1]) / (DRAWN_RADIUS * length).powi(2);
    let axial = if unneeded(stiffness.axial.is_some()) {
        drawn
    } else {
        document.positive(&table.key("axial"), stiffness.axial.ok_or_else(|| missing("axial"))?)?
    };
    let shear = if unneeded(stiffness.shear.is_some()) {
        [axial; 2]
    } else {
        pair("shear", stiffness.shear.ok_or_else(|| missing("shear"))?)?
    };
    Ok(Stiffness { bending, torsion, axial, shear })
}
