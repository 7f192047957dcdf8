//! Shapes from CSV files: a header line `x,y,z` (points, m) or `s,kappa1,kappa2,tau` (places, m, with curvature and twist, 1/m).

use super::rest::Written;
use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::file::{RestFile, RestSample, SceneFile};
use std::path::Path;
use strands::math::Vec3;

const POINTS: [&str; 3] = ["x", "y", "z"];
const SAMPLES: [&str; 4] = ["s", "kappa1", "kappa2", "tau"];

/// Puts the tables that a scene names into it, in place of their names.
pub(super) fn write_in(
    document: &Document,
    file: &mut SceneFile,
    folder: Option<&Path>,
) -> Result<(), SceneError> {
    for (rod, written) in &mut file.rods {
        if let Some(initial) = &mut written.initial
            && let Some(name) = &initial.csv
        {
            let path = KeyPath::of("rods").key(rod).key("initial").key("csv");
            // What are no points is said to be none where the scene is read.
            if let Written::Points(points) = read(document, folder, &path, name)? {
                initial.points = Some(points.iter().map(|point| point.to_array()).collect());
                initial.csv = None;
            }
        }
        let Some(rest) = &mut written.rest else { continue };
        let Some(name) = rest.csv.take() else { continue };
        let path = KeyPath::of("rods").key(rod).key("rest").key("csv");
        *rest = match read(document, folder, &path, &name)? {
            Written::Points(points) => {
                let points = points.iter().map(|point| point.to_array()).collect();
                RestFile { points: Some(points), ..RestFile::default() }
            }
            Written::Samples(samples) => {
                let sample = |(s, curvature): (f64, Vec3)| RestSample { s, curvature: curvature.to_array() };
                let samples = samples.into_iter().map(sample).collect();
                RestFile { samples: Some(samples), ..RestFile::default() }
            }
        };
    }
    Ok(())
}

/// Reads a table that lies beside the scene.
pub(super) fn read(
    document: &Document,
    folder: Option<&Path>,
    path: &KeyPath,
    name: &str,
) -> Result<Written, SceneError> {
    let Some(folder) = folder else {
        let error =
            document.error(path, format!("cannot read {name}: this scene has no folder to find it in"));
        return Err(error.mend("give the shape in the scene itself, as `points` or `samples`"));
    };
    let file = folder.join(name);
    let text = std::fs::read_to_string(&file).map_err(|error| {
        let error = document.error(path, format!("cannot read {}: {error}", file.display()));
        error.mend("the path is relative to the folder of the scene")
    })?;
    parse(&text).map_err(|(line, what)| {
        let error = document.error(path, format!("{}, line {line}: {what}", file.display()));
        error.mend("the first line is `x,y,z` for points in metres, or `s,kappa1,kappa2,tau`; every other line has as many numbers")
    })
}

fn parse(text: &str) -> Result<Written, (u64, String)> {
    let mut reader =
        csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let broken = |error: csv::Error| (error.position().map_or(1, csv::Position::line), error.to_string());
    let header = reader.headers().map_err(broken)?.clone();
    let columns: Vec<&str> = header.iter().collect();
    let points = columns == POINTS;
    if !points && columns != SAMPLES {
        return Err((1, format!("the columns are `{}`", columns.join(","))));
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map_or(1, csv::Position::line);
        let number = |cell: &str| match cell.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err((line, format!("`{cell}` is no finite number"))),
        };
        rows.push(record.iter().map(number).collect::<Result<Vec<_>, _>>()?);
    }
    // The reader has made sure that every row is as long as the header.
    let vector = |row: &[f64]| Vec3::new(row[0], row[1], row[2]);
    Ok(if points {
        Written::Points(rows.iter().map(|row| vector(row)).collect())
    } else {
        Written::Samples(rows.iter().map(|row| (row[0], vector(&row[1..]))).collect())
    })
}
