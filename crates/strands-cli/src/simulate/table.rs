//! What a person reads of a simulation.

use std::fmt::Write;

use strands::dynamics::Settings;
use strands_scene::Model;
use strands_scene::write::{End, Frame, FrameEnergy, Ran};

use crate::units::engineering;

/// How many frames are shown.
const ROWS: usize = 24;

/// The table, then how it went.
pub fn table(model: &Model, settings: &Settings, frames: &[Frame], ran: &Ran) -> String {
    let mut out = format!("{}\n", model.name);
    let header = ["time", "kinetic", "elastic", "of loads", "dissipated"];
    let [time, kinetic, elastic, load, dissipated] = header;
    let _ = writeln!(
        out,
        "  {time:>10}  {kinetic:>11}  {elastic:>11}  {load:>11}  {dissipated:>11}  end of {}, m",
        model.rods[0].name
    );
    let each = frames.len().div_ceil(ROWS);
    for (i, frame) in frames.iter().enumerate() {
        if i % each != 0 && i + 1 != frames.len() {
            continue;
        }
        let FrameEnergy { kinetic, elastic, load, dissipated, .. } = frame.energy;
        let poses = &frame.rods[0].poses;
        let end = poses[poses.len() - 1].position;
        let _ = writeln!(
            out,
            "  {:>8.4} s  {:>11}  {:>11}  {:>11}  {:>11}  ({:.4}, {:.4}, {:.4})",
            frame.time,
            engineering(kinetic, "J"),
            engineering(elastic, "J"),
            engineering(load, "J"),
            engineering(dissipated, "J"),
            end.x,
            end.y,
            end.z
        );
    }
    if ran.steps > 0 {
        let step = (frames[frames.len() - 1].time - frames[0].time) / ran.steps as f64;
        let _ = writeln!(
            out,
            "  {} steps of {} by {}, {} a step: {:.1} times as fast as real time",
            ran.steps,
            engineering(step, "s"),
            settings.integrator.name(),
            engineering(step / ran.real_time_factor, "s"),
            ran.real_time_factor
        );
    }
    let taken = frames[0].energy.total() - frames[frames.len() - 1].energy.total();
    let _ = writeln!(
        out,
        "  {} of energy {} by the integrator",
        engineering(taken.abs(), "J"),
        if taken < 0.0 { "added" } else { "taken" }
    );
    match &ran.end {
        End::Finished => {}
        End::Interrupted => out.push_str("  interrupted: the frames until then are kept\n"),
        End::Failed(reason) => {
            let _ = writeln!(out, "  failed: {reason}");
        }
    }
    out
}
