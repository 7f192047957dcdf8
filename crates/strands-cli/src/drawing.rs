//! A small picture of rods in braille characters, as seen across the plane in which they mostly lie.

use strands::math::{Mat3, Vec3};

/// Width of the picture in characters; its height follows from the shape.
const COLUMNS: usize = 60;
/// The greatest height in characters.
const ROWS: usize = 16;
/// Dots of a braille character across and down.
const CELL: [usize; 2] = [2, 4];

/// What the picture shows.
#[derive(Debug, PartialEq)]
pub struct Drawing {
    /// The lines of the picture.
    pub lines: Vec<String>,
    /// What its whole width is, m.
    pub width: f64,
    /// What its whole height is, m.
    pub height: f64,
}

/// Draws polylines. `up` is the direction that should point up where the plane allows.
pub fn draw(lines: &[Vec<Vec3>], up: Vec3) -> Drawing {
    let points: Vec<Vec3> = lines.iter().flatten().copied().collect();
    let (right, up) = plane(&points, up);
    let flat: Vec<Vec<[f64; 2]>> =
        lines.iter().map(|line| line.iter().map(|p| [p.dot(right), -p.dot(up)]).collect()).collect();
    let bound = |axis: usize| {
        let values = flat.iter().flatten().map(|p| p[axis]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let ((x0, x1), (y0, y1)) = (bound(0), bound(1));
    let dots = [COLUMNS * CELL[0] - 1, ROWS * CELL[1] - 1];
    // Metres a dot, the same both ways: dots are square where characters are twice as high as wide.
    let size = ((x1 - x0) / dots[0] as f64).max((y1 - y0) / dots[1] as f64).max(f64::MIN_POSITIVE);
    let place = |p: &[f64; 2]| [((p[0] - x0) / size).round() as usize, ((p[1] - y0) / size).round() as usize];
    let [last_column, last_row] = place(&[x1, y1]);
    let mut canvas = Canvas::new(last_column / CELL[0] + 1, last_row / CELL[1] + 1);
    for line in &flat {
        for pair in line.windows(2) {
            canvas.stroke(place(&pair[0]), place(&pair[1]));
        }
    }
    Drawing { lines: canvas.lines(), width: x1 - x0, height: y1 - y0 }
}

/// The plane in which points mostly lie, as the directions on the screen: to the right and up.
fn plane(points: &[Vec3], up: Vec3) -> (Vec3, Vec3) {
    let mean = points.iter().fold(Vec3::ZERO, |sum, p| sum + *p) * (1.0 / points.len().max(1) as f64);
    let mut spread = Mat3::ZERO;
    for p in points {
        let d = *p - mean;
        spread = spread + Mat3::outer(d, d);
    }
    let first = largest_direction(&spread, up);
    let rest = spread - Mat3::outer(first, first).scaled(first.dot(spread * first));
    let side = up - first * up.dot(first);
    let second = largest_direction(&rest, side);
    let second = (second - first * second.dot(first)).normalized().unwrap_or(first.any_orthonormal());
    let in_plane = first * up.dot(first) + second * up.dot(second);
    let up = if in_plane.norm() > 0.2 { in_plane.normalized().unwrap_or(second) } else { second };
    let normal = first.cross(second);
    let right = up.cross(normal);
    // Which side of the plane is seen is free: the one on which the longer world axis runs to the right.
    let forward = if right.x.abs() > right.y.abs() { right.x } else { right.y };
    (if forward < 0.0 { -right } else { right }, up)
}

/// The direction in which a symmetric matrix stretches most, by repeated multiplication; `otherwise` where it is zero.
fn largest_direction(matrix: &Mat3, otherwise: Vec3) -> Vec3 {
    let mut v = Vec3::new(1.0, 0.7, 0.4);
    for _ in 0..64 {
        match (*matrix * v).normalized() {
            Some(next) => v = next,
            None => return otherwise.normalized().unwrap_or(Vec3::Z),
        }
    }
    v
}

struct Canvas {
    columns: usize,
    cells: Vec<u8>,
}

impl Canvas {
    fn new(columns: usize, rows: usize) -> Self {
        Self { columns, cells: vec![0; columns * rows] }
    }

    fn dot(&mut self, x: usize, y: usize) {
        /// The bit of each dot of a braille character, row by row (Unicode, block U+2800).
        const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        let cell = (y / CELL[1]) * self.columns + x / CELL[0];
        self.cells[cell] |= BITS[y % CELL[1]][x % CELL[0]];
    }

    fn stroke(&mut self, from: [usize; 2], to: [usize; 2]) {
        let steps = from[0].abs_diff(to[0]).max(from[1].abs_diff(to[1])).max(1);
        let between = |axis: usize, i: usize| {
            let (a, b) = (from[axis] as f64, to[axis] as f64);
            (a + (b - a) * i as f64 / steps as f64).round() as usize
        };
        for i in 0..=steps {
            self.dot(between(0, i), between(1, i));
        }
    }

    fn lines(&self) -> Vec<String> {
        let line = |cells: &[u8]| {
            let text: String =
                cells.iter().map(|bits| char::from_u32(0x2800 + u32::from(*bits)).unwrap_or(' ')).collect();
            text.trim_end_matches('\u{2800}').to_owned()
        };
        self.cells.chunks(self.columns).map(line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_rod_is_one_line_across() {
        let drawing = draw(&[vec![Vec3::ZERO, Vec3::X]], Vec3::Z);
        assert_eq!(drawing.lines.len(), 1);
        assert_eq!(drawing.lines[0].chars().count(), COLUMNS);
        assert!((drawing.width - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_hangs_hangs_down() {
        let drawing = draw(&[vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, -0.5)]], Vec3::Z);
        assert!(drawing.lines.first().is_some_and(|line| line.chars().count() == COLUMNS));
        assert!(drawing.lines.last().is_some_and(|line| line.starts_with('\u{2800}')));
    }
}
