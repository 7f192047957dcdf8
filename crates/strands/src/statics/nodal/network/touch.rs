//! Contacts in the linear system: blocks between the frames that touch.

use super::{NONE, Network};
use crate::math::{Mat3, Vec3, Wrench};
use crate::statics::nodal::elimination::Square;

/// Where two surfaces touch: the ends of the segments that they are about, less those that stand still.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub ends: [Option<TouchEnd>; 4],
    /// How the force on the first side is to change at once, N.
    pub pull: Vec3,
    /// How it resists a shift of the first side's place that touches against the second's, N/m.
    pub stiffness: Mat3,
    /// How the force of each end resists a shift of each other, N/m, where the normal turns with them.
    pub bends: Option<[[Mat3; 4]; 4]>,
    /// How the moment of that force resists them, N.
    pub turns: Option<[[Mat3; 4]; 4]>,
}

/// An end of a segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TouchEnd {
    /// The assembly's number of its frame.
    pub frame: usize,
    /// How much of the force it takes, less than nothing on the second side.
    pub weight: f64,
    /// Where it is, and where the surface that turns with its frame is touched.
    pub place: Vec3,
    pub touches: Vec3,
}

impl Network {
    /// Adds how a contact's force resists shifts of the frames that it is between, and is to change at once.
    pub(super) fn add_touch(&mut self, touch: &Touch) {
        let axes = self.axes;
        let per_shift = axes.length / axes.force;
        for (k, on) in touch.ends.iter().enumerate() {
            let Some(on) = on else { continue };
            let (row, touched, place) = (self.number[on.frame], axes.at(on.touches), axes.at(on.place));
            let pull = touch.pull * (on.weight / axes.force);
            self.add_right(row, Wrench::new(touched.cross(pull), pull));
            for (l, of) in touch.ends.iter().enumerate() {
                let Some(of) = of else { continue };
                let stiffness = touch.stiffness.scaled(on.weight * of.weight * per_shift);
                let mut block = NONE;
                add_between_places(&mut block, touched, &stiffness, axes.at(of.touches));
                if let Some(bends) = &touch.bends {
                    add_between_places(&mut block, place, &bends[k][l].scaled(per_shift), axes.at(of.place));
                }
                if let Some(turns) = &touch.turns {
                    add_couple(&mut block, &turns[k][l].scaled(axes.length / axes.moment), axes.at(of.place));
                }
                self.add_block(row, self.number[of.frame], &block);
            }
        }
    }

    /// How the first side of a contact shifts against the second in the step, m.
    pub fn shift_apart(&self, ends: &[Option<TouchEnd>; 4]) -> Vec3 {
        ends.iter().flatten().fold(Vec3::ZERO, |sum, end| {
            let step = self.variation(self.number[end.frame], &self.axes.at(end.touches));
            sum + step.linear * (end.weight * self.axes.length)
        })
    }
}

/// Adds how the force at a place resists shifts of another one, as it resists variations about the axes' origin.
#[inline]
fn add_between_places(block: &mut Square<f64>, on: Vec3, stiffness: &Mat3, of: Vec3) {
    // By a turn the other place shifts by `η × of`.
    let by_turn = *stiffness * Mat3::hat(of);
    let columns = by_turn.cols.map(|column| column * -1.0).into_iter().chain(stiffness.cols);
    for (c, force) in columns.enumerate() {
        let moment = on.cross(force);
        for (row, x) in block.iter_mut().zip([moment.x, moment.y, moment.z, force.x, force.y, force.z]) {
            row[c] += x;
        }
    }
}

/// Adds how a moment resists shifts of a place.
#[inline]
fn add_couple(block: &mut Square<f64>, stiffness: &Mat3, of: Vec3) {
    let by_turn = *stiffness * Mat3::hat(of);
    let columns = by_turn.cols.map(|column| column * -1.0).into_iter().chain(stiffness.cols);
    for (c, moment) in columns.enumerate() {
        for (row, x) in block.iter_mut().zip([moment.x, moment.y, moment.z]) {
            row[c] += x;
        }
    }
}
