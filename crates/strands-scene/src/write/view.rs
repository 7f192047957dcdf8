//! The plane of a picture: across the direction in which a cloud of points is flattest.

use strands::math::{Mat3, Vec3};

/// Turns of Jacobi's method; three off-diagonal entries fall below round-off in far fewer.
const MAX_TURNS: usize = 60;
/// Points flatter than this part of their extent have no plane of their own.
const FLAT: f64 = 1e-6;

/// Two orthonormal directions in the world: to the right and up.
pub(super) struct View {
    right: Vec3,
    up: Vec3,
}

impl View {
    /// The view of points along the least of their principal axes, the world's z as upright as that allows and x to the right.
    pub fn of(points: &[Vec3]) -> Self {
        let count = points.len().max(1) as f64;
        let mean = points.iter().fold(Vec3::ZERO, |sum, point| sum + *point) * (1.0 / count);
        let spread =
            points.iter().fold(Mat3::ZERO, |sum, point| sum + Mat3::outer(*point - mean, *point - mean));
        let [(_, least), (middle, _), (most, longest)] = principal_axes(spread);
        // A straight rod is seen from the front, a point too.
        let normal =
            if middle > FLAT * FLAT * most { least } else { Vec3::Y - longest * longest.dot(Vec3::Y) };
        let normal = normal.normalized().unwrap_or(Vec3::X);
        // Seen along z there is no upright: y is up.
        let upright = if normal.z.abs() < 0.99 { Vec3::Z } else { Vec3::Y };
        let up = (upright - normal * normal.dot(upright)).normalized().unwrap_or(Vec3::Z);
        let right = up.cross(normal);
        let forward = if right.x.abs() > 1e-9 { right.x } else { right.y };
        Self { right: if forward < 0.0 { right * -1.0 } else { right }, up }
    }

    /// A point's coordinates to the right and up, m.
    pub fn project(&self, point: Vec3) -> [f64; 2] {
        [self.right.dot(point), self.up.dot(point)]
    }
}

/// Eigenvalues of a symmetric matrix with their unit vectors, growing (Jacobi 1846; Golub & Van Loan, section 8.5).
fn principal_axes(matrix: Mat3) -> [(f64, Vec3); 3] {
    let mut a = matrix.cols.map(Vec3::to_array);
    let mut axes = Mat3::IDENTITY.cols.map(Vec3::to_array);
    for turn in 0..MAX_TURNS {
        let (p, q) = [(0, 1), (0, 2), (1, 2)][turn % 3];
        if a[p][q] == 0.0 {
            continue;
        }
        let angle = 0.5 * (2.0 * a[p][q]).atan2(a[q][q] - a[p][p]);
        let (sin, cos) = angle.sin_cos();
        let rotate = |x: f64, y: f64| (cos * x - sin * y, sin * x + cos * y);
        for row in &mut a {
            (row[p], row[q]) = rotate(row[p], row[q]);
        }
        let (mut first, mut second) = (a[p], a[q]);
        for i in 0..3 {
            (first[i], second[i]) = rotate(a[p][i], a[q][i]);
            (axes[p][i], axes[q][i]) = rotate(axes[p][i], axes[q][i]);
        }
        (a[p], a[q]) = (first, second);
    }
    let mut found: [(f64, Vec3); 3] = std::array::from_fn(|i| (a[i][i], Vec3::from(axes[i])));
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_curve_is_seen_face_on_and_upright() {
        let tilt = 0.4_f64;
        let across = Vec3::new(tilt.cos(), tilt.sin(), 0.0);
        let points: Vec<Vec3> =
            (0..50).map(|i| f64::from(i) * 0.1).map(|t| across * t + Vec3::Z * t.sin()).collect();
        let view = View::of(&points);
        let [x, y] = view.project(across * 2.0 + Vec3::Z * 0.5);
        assert!((x - 2.0).abs() < 1e-9 && (y - 0.5).abs() < 1e-9, "{x} {y}");
    }

    #[test]
    fn a_straight_line_is_seen_at_full_length() {
        for direction in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.6, 0.0, 0.8)] {
            let points: Vec<Vec3> = (0..9).map(|i| direction * f64::from(i)).collect();
            let [x, y] = View::of(&points).project(direction);
            assert!((x.hypot(y) - 1.0).abs() < 1e-9, "{direction:?}");
        }
    }
}
