//! NumPy's archive of arrays.

use super::{Frame, FrameEnergy};
use crate::model::Model;
use std::io::{Cursor, Write};
use strands::math::{Pose, Vec6};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// A simulation as an `.npz` file of double precision, for `numpy.load`.
///
/// With F frames and N nodes of a rod: `time` (F), `energy.kinetic`, `.elastic`, `.load`, `.dissipated` and, where it is known, `.work` (F); and for each
/// rod by its name `NAME.s` (N), `NAME.position` (F×N×3), `NAME.orientation` (F×N×4, w first), `NAME.velocity` and `NAME.angular_velocity` (F×N×3),
/// `NAME.strain` and `NAME.stress` (F×(N−1)×6). A body has the four of a node, of one node (F×1×…). Meanings and units are those of
/// [`motion_json`](super::motion_json).
pub fn motion_npz(model: &Model, frames: &[Frame]) -> Vec<u8> {
    let mut archive = Archive(ZipWriter::new(Cursor::new(Vec::new())));
    let f = frames.len();
    archive.array("time", &[f], frames.iter().map(|frame| frame.time));
    let energies = |frame: &Frame| {
        let FrameEnergy { kinetic, elastic, load, dissipated, .. } = frame.energy;
        [kinetic, elastic, load, dissipated]
    };
    for (i, name) in ["kinetic", "elastic", "load", "dissipated"].into_iter().enumerate() {
        archive.array(&format!("energy.{name}"), &[f], frames.iter().map(|frame| energies(frame)[i]));
    }
    if let Some(work) = frames.iter().map(|frame| frame.energy.work).collect::<Option<Vec<f64>>>() {
        archive.array("energy.work", &[f], work);
    }
    for (i, rod) in model.rods.iter().enumerate() {
        let s = rod.problem.rod.mesh().nodes();
        archive.array(&format!("{}.s", rod.name), &[s.len()], s.iter().copied());
        let rods = || frames.iter().map(move |frame| &frame.rods[i]);
        let nodes = rods().map(|rod| (rod.poses.as_slice(), rod.velocities.as_slice()));
        archive.nodes(&rod.name, [f, s.len()], nodes);
        let elements = [f, s.len() - 1, 6];
        let strain = rods().flat_map(|rod| &rod.strain).flat_map(|strain| strain.to_array());
        archive.array(&format!("{}.strain", rod.name), &elements, strain);
        let stress = rods().flat_map(|rod| &rod.stress).flat_map(|stress| stress.to_array());
        archive.array(&format!("{}.stress", rod.name), &elements, stress);
    }
    for i in 0..frames.first().map_or(0, |frame| frame.bodies.len()) {
        let bodies = frames.iter().map(|frame| &frame.bodies[i]);
        let nodes =
            bodies.map(|body| (std::slice::from_ref(&body.pose), std::slice::from_ref(&body.velocity)));
        archive.nodes(&frames[0].bodies[i].name, [f, 1], nodes);
    }
    archive.finished()
}

/// A zip archive of arrays, not compressed, as `numpy.savez` writes it.
struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    /// The frames of nodes and how they move.
    fn nodes<'a>(
        &mut self,
        name: &str,
        [f, n]: [usize; 2],
        nodes: impl Iterator<Item = (&'a [Pose], &'a [Vec6])> + Clone,
    ) {
        let poses = || nodes.clone().flat_map(|(poses, _)| poses);
        let velocities = || nodes.clone().flat_map(|(_, velocities)| velocities);
        self.array(
            &format!("{name}.position"),
            &[f, n, 3],
            poses().flat_map(|pose| pose.position.to_array()),
        );
        let orientations = poses().flat_map(|pose| pose.orientation().to_wxyz());
        self.array(&format!("{name}.orientation"), &[f, n, 4], orientations);
        let linear = velocities().flat_map(|velocity| velocity.linear.to_array());
        self.array(&format!("{name}.velocity"), &[f, n, 3], linear);
        let angular = velocities().flat_map(|velocity| velocity.angular.to_array());
        self.array(&format!("{name}.angular_velocity"), &[f, n, 3], angular);
    }

    /// Adds an array in NumPy's format, version 1.0 (NumPy, `numpy.lib.format`): a header that is padded to a multiple of 64 bytes, then the numbers.
    fn array(&mut self, name: &str, shape: &[usize], values: impl IntoIterator<Item = f64>) {
        let shape = match shape {
            [n] => format!("{n},"),
            _ => shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", "),
        };
        let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}");
        let before = b"\x93NUMPY\x01\x00".len() + 2;
        let padded = (before + header.len() + 1).next_multiple_of(64);
        header.extend(std::iter::repeat_n(' ', padded - before - header.len() - 1));
        header.push('\n');
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(values.into_iter().flat_map(f64::to_le_bytes));
        let options =
            SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(true);
        let written = self.0.start_file(format!("{name}.npy"), options).map_err(std::io::Error::from);
        written.and_then(|()| self.0.write_all(&bytes)).unwrap_or_else(in_memory);
    }

    fn finished(self) -> Vec<u8> {
        self.0.finish().map_err(std::io::Error::from).unwrap_or_else(in_memory).into_inner()
    }
}

fn in_memory<T>(error: std::io::Error) -> T {
    unreachable!("in memory: {error}")
}
