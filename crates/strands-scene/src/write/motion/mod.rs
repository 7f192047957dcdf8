//! The answer of a simulation: frames in time.

use super::csv::table;
use crate::model::Model;
use serde_json::{Map, Value, json as value};
use strands::dynamics::{Budget, State};

/// The rods of a scene at one time.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The time, s.
    pub time: f64,
    /// The rods, in the scene's order.
    pub rods: Vec<Moved>,
    /// Newton iterations since the frame before, of all rods together.
    pub iterations: usize,
    /// The largest residual since then.
    pub residual: f64,
}

/// A rod at one time.
#[derive(Clone, Debug)]
pub struct Moved {
    /// How it moves.
    pub state: State,
    /// Where its energy is.
    pub energy: Budget,
}

/// A simulation as one JSON object: `scene`, `status` ("finished", or "failed" with the `reason`), `steps`, `real_time_factor` (simulated seconds
/// a second) and `frames`, each with the time `t` (s), the `energy` (J: `kinetic`, `elastic`, `gravity`, which is that of all dead loads, and
/// `dissipated` since the start) of all rods together, `newton_iterations` and the largest `residual` since the frame before, and `rods`: for each by
/// its name at the nodes `s` (m), `position` (m), `orientation` (quaternion, w first), `velocity` (m/s, world axes) and `angular_velocity` (rad/s, the
/// node's own axes).
pub fn motion_json(
    model: &Model,
    frames: &[Frame],
    steps: usize,
    real_time_factor: f64,
    failure: Option<&str>,
) -> String {
    let mut answer = Map::new();
    answer.insert("scene".into(), value!(model.name));
    answer.insert("status".into(), value!(if failure.is_some() { "failed" } else { "finished" }));
    if let Some(reason) = failure {
        answer.insert("reason".into(), value!(reason));
    }
    answer.insert("steps".into(), value!(steps));
    answer.insert("real_time_factor".into(), value!(real_time_factor));
    answer.insert("frames".into(), frames.iter().map(|frame| one(model, frame)).collect());
    Value::Object(answer).to_string()
}

fn one(model: &Model, frame: &Frame) -> Value {
    let sum = |of: fn(&Budget) -> f64| frame.rods.iter().map(|rod| of(&rod.energy)).sum::<f64>();
    let rods = model.rods.iter().zip(&frame.rods).map(|(rod, moved)| {
        let State { poses, velocities, .. } = &moved.state;
        let answer = value!({
            "s": rod.problem.rod.mesh().nodes(),
            "position": poses.iter().map(|pose| pose.position.to_array()).collect::<Vec<_>>(),
            "orientation": poses.iter().map(|pose| pose.orientation().to_wxyz()).collect::<Vec<_>>(),
            "velocity": velocities.iter().map(|velocity| velocity.linear.to_array()).collect::<Vec<_>>(),
            "angular_velocity": velocities.iter().map(|velocity| velocity.angular.to_array()).collect::<Vec<_>>(),
        });
        (rod.name.clone(), answer)
    });
    value!({
        "t": frame.time,
        "energy": {
            "kinetic": sum(|energy| energy.kinetic),
            "elastic": sum(|energy| energy.elastic),
            "gravity": sum(|energy| energy.load),
            "dissipated": sum(|energy| energy.dissipated),
        },
        "newton_iterations": frame.iterations,
        "residual": frame.residual,
        "rods": Value::Object(rods.collect()),
    })
}

/// A simulation as CSV, one row a node and frame: `t`, `rod`, `s`, `x` to `z`, `qw` to `qz`, and the velocities `vx` to `vz` (world axes) and `wx` to
/// `wz` (the node's own axes).
pub fn motion_csv(model: &Model, frames: &[Frame]) -> String {
    let columns =
        ["t", "rod", "s", "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"];
    let mut rows = Vec::new();
    for frame in frames {
        for (rod, moved) in model.rods.iter().zip(&frame.rods) {
            for (node, s) in rod.problem.rod.mesh().nodes().iter().enumerate() {
                let (pose, velocity) = (&moved.state.poses[node], &moved.state.velocities[node]);
                let numbers = [*s]
                    .into_iter()
                    .chain(pose.position.to_array())
                    .chain(pose.orientation().to_wxyz())
                    .chain(velocity.linear.to_array())
                    .chain(velocity.angular.to_array());
                let mut row = vec![frame.time.to_string(), rod.name.clone()];
                row.extend(numbers.map(|number| number.to_string()));
                rows.push(row);
            }
        }
    }
    table(&columns, rows)
}
