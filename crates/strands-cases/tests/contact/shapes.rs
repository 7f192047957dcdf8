//! Knots as lines, and what says which knot a closed line is.

use super::set_up::Line;
use core::f64::consts::PI;
use strands::math::Vec3;

/// An open overhand knot of a thread of a radius, loose: a loop and two tails along z. Its strands go round each other by three half turns where they meet.
pub fn overhand(loop_radius: f64, tail: f64, radius: f64) -> Line {
    const FINE: usize = 4000;
    let (r, h) = (loop_radius, radius);
    let braid = 0.7 * r;
    let strand = |z: f64, side: f64| {
        let circle = r - (r * r - z * z).sqrt();
        let half = (0.25 * circle * circle + (1.1 * h).powi(2)).sqrt();
        let x = (0.5 + 0.5 * z / (3.2 * (2.0 * h * r).sqrt())).clamp(0.0, 1.0);
        let (sin, cos) = (3.0 * PI * x * x * (3.0 - 2.0 * x)).sin_cos();
        Vec3::new(0.5 * circle + side * half * cos, side * half * sin, z)
    };
    let strand =
        |side: f64| (0..=FINE).map(move |k| strand(braid * (2.0 * k as f64 / FINE as f64 - 1.0), side));
    let opening = (braid / r).asin();
    let circle = (1..FINE).map(|k| {
        let (sin, cos) = (opening + 2.0 * (PI - opening) * k as f64 / FINE as f64).sin_cos();
        Vec3::new(r * (1.0 - cos), 0.0, r * sin)
    });
    let ends = [-tail, tail].map(|z| Vec3::new(0.0, 0.0, z));
    let places = [ends[0]].into_iter().chain(strand(-1.0)).chain(circle).chain(strand(1.0));
    Line::through(places.chain([ends[1]]).collect())
}

/// Two bights that go through each other as in a square knot, of threads of a radius, loose: the first one's legs go to +x, for so long, the other's to −x. They are as wide as high.
pub fn square(size: f64, leg: f64, radius: f64) -> [Line; 2] {
    const FINE: usize = 2000;
    let (narrow, wide, lift) = (0.35 * size, size, 2.5 * radius);
    let smooth = |x: f64| {
        let x = x.clamp(0.0, 1.0);
        x * x * (3.0 - 2.0 * x)
    };
    let height = |x: f64| lift * (PI * x / size).cos() * (1.0 - smooth(x / size - 1.0));
    // From the end of a leg to the tip, at `−size`.
    let half: Vec<Vec3> = (0..=FINE)
        .map(|k| {
            let t = k as f64 / FINE as f64;
            if t < 0.5 {
                let x = (size + leg) * (1.0 - 2.0 * t);
                Vec3::new(x, narrow + (wide - narrow) * smooth(0.5 * (1.0 - x / size)), height(x))
            } else {
                let (sin, cos) = (PI * (t - 0.5)).sin_cos();
                let x = -size * sin;
                let wide = narrow + (wide - narrow) * smooth(0.5 * (1.0 - x / size));
                Vec3::new(x, wide * cos, height(x))
            }
        })
        .collect();
    let other_half = half[..FINE].iter().rev().map(|place| Vec3::new(place.x, -place.y, place.z));
    let one: Vec<Vec3> = half.iter().copied().chain(other_half).collect();
    let other = one.iter().map(|place| Vec3::new(-place.x, place.y, -place.z)).collect();
    [one, other].map(Line::through)
}

/// A thread of a radius that winds around itself along x by so many turns, at an angle to that, with a loop of about a size at the tip and tails along z.
pub fn plectoneme(alpha: f64, turns: f64, tail: f64, size: f64, radius: f64) -> Line {
    const FINE: usize = 4000;
    let r = radius;
    let height = turns * 2.0 * PI * r / alpha.tan();
    let bend = 4.0 * r;
    let (r1, tip) = (1.1 * r, 3.0 * size);
    // One strand from the ply's foot to its tip.
    let strand = |side: f64| {
        let ply = (0..=FINE).map(move |k| {
            let x = height * k as f64 / FINE as f64;
            let (sin, cos) = (x * alpha.tan() / r).sin_cos();
            Vec3::new(bend + x, -side * r1 * sin, side * r1 * cos)
        });
        let (sin, cos) = (height * alpha.tan() / r).sin_cos();
        let end = (1..=FINE).map(move |k| {
            // Even in the angle at its round end.
            let u = (0.5 * PI * k as f64 / FINE as f64).sin();
            let d = (r1 + 2.6 * size * u * u.sqrt()) * (1.0 - u).max(0.0).sqrt();
            Vec3::new(bend + height + tip * u, -side * d * sin, side * d * cos)
        });
        ply.chain(end)
    };
    let foot = |side: f64| {
        (0..FINE / 10).map(move |k| {
            let (sin, cos) = (0.5 * PI * k as f64 / (FINE / 10) as f64).sin_cos();
            Vec3::new(bend * (1.0 - cos), 0.0, side * (r1 + bend * (1.0 - sin)))
        })
    };
    let mut places = vec![Vec3::Z * -tail];
    places.extend(foot(-1.0));
    places.extend(strand(-1.0));
    let mut back: Vec<Vec3> = vec![Vec3::Z * tail];
    back.extend(foot(1.0));
    back.extend(strand(1.0));
    back.pop();
    places.extend(back.into_iter().rev());
    Line::through(places)
}

/// The determinant of a knot, by how a projection of it can be coloured (Fox): 1 where there is none, 3 of a trefoil, 9 of a square knot. It does not change unless
/// the line goes through itself.
pub fn determinant(closed: &[Vec3]) -> i64 {
    // Nothing of a knot is along these.
    let along = Vec3::new(0.331, 0.837, 0.435).normalized().unwrap();
    let first = along.any_orthonormal();
    let second = along.cross(first);
    let flat: Vec<[f64; 3]> = closed.iter().map(|p| [p.dot(first), p.dot(second), p.dot(along)]).collect();
    let n = flat.len();
    // Where along the line it crosses itself: where that is along it, the crossing, and whether it is under there.
    let mut passes: Vec<(f64, usize, bool)> = Vec::new();
    let mut crossings = 0;
    for i in 0..n {
        let (a, b) = (flat[i], flat[(i + 1) % n]);
        for j in i + 2..n {
            if i == 0 && j == n - 1 {
                continue;
            }
            let (c, d) = (flat[j], flat[(j + 1) % n]);
            let (u, v, w) =
                ([b[0] - a[0], b[1] - a[1]], [d[0] - c[0], d[1] - c[1]], [c[0] - a[0], c[1] - a[1]]);
            let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
            let (s, t) = (cross(w, v) / cross(u, v), cross(w, u) / cross(u, v));
            if !((0.0..1.0).contains(&s) && (0.0..1.0).contains(&t)) {
                continue;
            }
            let is_under = a[2] + (b[2] - a[2]) * s < c[2] + (d[2] - c[2]) * t;
            passes.push((i as f64 + s, crossings, is_under));
            passes.push((j as f64 + t, crossings, !is_under));
            crossings += 1;
        }
    }
    passes.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Colours change where it is under: twice the one over is both of the one under.
    let mut rows = vec![vec![0.0_f64; crossings]; crossings];
    let mut colour = 0;
    for (_, crossing, is_under) in passes {
        if is_under {
            rows[crossing][colour] -= 1.0;
            colour = (colour + 1) % crossings;
            rows[crossing][colour] -= 1.0;
        } else {
            rows[crossing][colour] += 2.0;
        }
    }
    // Without one row and column.
    let mut product = 1.0;
    let size = crossings.saturating_sub(1);
    for k in 0..size {
        let pivot = (k..size).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs())).unwrap();
        rows.swap(k, pivot);
        product *= rows[k][k];
        if product == 0.0 {
            return 0;
        }
        for i in k + 1..size {
            let factor = rows[i][k] / rows[k][k];
            for j in k..size {
                rows[i][j] -= factor * rows[k][j];
            }
        }
    }
    product.abs().round() as i64
}
