//! The elimination of the nodal system: node by node from the start to the end, each a block of six, whose pivots give the inertia.
//!
//! Written for one rod or several side by side.

use super::second_variation::TURNING;
use super::{Hold, Nodal, Resists, acting, imbalance};
use crate::math::{Kernel, Mat3, Real, Register, Vec3, Vec6, Wrench};

/// A pivot below this part of its block's diagonal is none.
pub(super) const SMALLEST_PIVOT: f64 = 1e-15;

/// Six rows of a block.
pub(super) type Square<R> = [[R; 6]; 6];
/// Six rows of a block, and two columns more: what acts, and another right-hand side.
pub(super) type Block<R> = [[R; 8]; 6];
const ACTING: usize = 6;
const OTHER: usize = 7;

/// The signs of the pivots.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertia<R> {
    /// How many are negative.
    pub negative: R,
    /// How many vanish: what follows from these is worth nothing.
    pub vanished: R,
}

/// Eliminates the nodes from the first to the last, and puts the step back together.
pub(super) struct Eliminate<'a, R> {
    pub nodal: &'a mut Nodal<R>,
    pub drag: R,
}

impl<R: Register> Kernel for Eliminate<'_, R> {
    type Output = Inertia<R>;

    #[inline(always)]
    fn run(self) -> Inertia<R> {
        let Self { nodal, drag } = self;
        let n = nodal.links.len();
        nodal.follows.resize(n + 1, [[R::zero(); 8]; 6]);
        nodal.steps.resize(n + 1, Vec6::zero());
        if R::LANES == 1 {
            nodal.pivots.resize(n + 1, [[R::zero(); 6]; 6]);
        }
        let Nodal { links, resists, couplings, loads, load_slopes, inertial_slopes, holds, .. } = nodal;
        let Nodal { follows, pivots, steps, others, other_steps, .. } = nodal;
        let columns = if others.is_empty() { OTHER } else { OTHER + 1 };
        let mut inertia = Inertia { negative: R::zero(), vanished: R::zero() };
        // What the nodes before take from the pivot, and add to what acts. One rod starts from the former, negated; several subtract it. So too one
        // rod's block is local, to stay in registers, and those of several are in their places: each is the faster way by a tenth.
        let mut earlier = [[R::zero(); 8]; 6];
        // Of all rods.
        let no_drag = R::all(drag.abs().at_most(0.0));
        debug_assert!(others.is_empty() || others.len() == n + 1);
        let (mut next_hold, mut next_slope) = (0, 0);
        for i in 0..=n {
            let mut pivot = [[R::zero(); 6]; 6];
            if R::LANES == 1 {
                for r in 0..6 {
                    pivot[r].copy_from_slice(&earlier[r][..6]);
                }
            }
            if !no_drag {
                add_drag(&mut pivot, drag);
            }
            subtract_dead_moment_slope(&mut pivot, loads[i].linear);
            if i > 0 {
                add(&mut pivot, &on_far(&resists[i - 1].stiffness, links[i - 1].carried));
            }
            if let Some(slopes) = inertial_slopes.get(i) {
                subtract_inertial_slopes(&mut pivot, slopes);
            }
            if R::LANES > 1 {
                subtract(&mut pivot, &earlier);
            }
            while load_slopes.get(next_slope).is_some_and(|(node, _)| *node == i) {
                subtract(&mut pivot, &load_slopes[next_slope].1);
                next_slope += 1;
            }
            let mut local = [[R::zero(); 8]; 6];
            let right = if R::LANES == 1 { &mut local } else { &mut follows[i] };
            let acts = parts(acting(loads, links, i));
            for r in 0..6 {
                right[r][ACTING] = acts[r] + earlier[r][ACTING];
            }
            if let Some(other) = others.get(i) {
                let other = parts(*other);
                for r in 0..6 {
                    right[r][OTHER] = other[r] + earlier[r][OTHER];
                }
            }
            let after = resists.get(i);
            match after {
                Some(after) => {
                    see_from(&after.arm, &mut pivot, right);
                    add(&mut pivot, &after.stiffness);
                    let mut upper = on_far(&after.stiffness, links[i].carried);
                    if let Some(coupling) = couplings.get(i) {
                        add(&mut upper, &coupling.upper);
                    }
                    for r in 0..6 {
                        right[r][..6].copy_from_slice(&upper[r]);
                    }
                }
                None => {
                    for row in right.iter_mut() {
                        row[..6].fill(R::zero());
                    }
                }
            }
            let hold = holds.get(next_hold).filter(|hold| hold.node == i);
            if let Some(hold) = hold {
                next_hold += 1;
                // Few nodes are held: out of the way of the others' registers.
                R::run(Restrict { hold, after, pivot: &mut pivot, right });
            }
            reduce(&mut pivot, right, columns, &mut inertia);
            if let Some(hold) = hold {
                R::run(Expand { hold, after, follow: right });
            }
            if let Some(after) = after {
                let lower = couplings.get(i).map_or(&after.stiffness, |coupling| &coupling.lower);
                to_next(lower, right, columns, &mut earlier);
            }
            if R::LANES == 1 {
                (follows[i], pivots[i]) = (local, pivot);
            }
        }
        put_together(resists, follows, ACTING, steps);
        other_steps.clear();
        if !others.is_empty() {
            other_steps.resize(n + 1, Vec6::zero());
            put_together(resists, follows, OTHER, other_steps);
        }
        inertia
    }
}

/// Solves for what acts now with the factors that one rod was last [eliminated](Eliminate) to, as if all had turned with its nodes since: then what is stiff
/// does not get in the way of what is not.
pub(super) struct Substitute<'a> {
    pub nodal: &'a mut Nodal,
}

impl Kernel for Substitute<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Nodal { links, resists, couplings, loads, held, follows, pivots, since, steps, .. } = self.nodal;
        let (mut earlier, mut next_hold) = (Vec6::ZERO, 0);
        for i in 0..follows.len() {
            let after = resists.get(i);
            let mut acts = imbalance(loads, links, i).turned_back_by(&since[i]) + earlier;
            let mut pull = Wrench::ZERO;
            if let Some(after) = after {
                acts.angular -= after.arm.cross(acts.linear);
                pull = links[i].pull.turned_back_by(&since[i + 1]);
                acts += pull;
            }
            let mut x = parts(acts);
            if let Some(hold) = held.get(next_hold).filter(|hold| hold.node == i) {
                next_hold += 1;
                let free = hold.free_seen_from(after);
                x = times(&transposed(&free), &x);
                substitute(&pivots[i], &mut x);
                x = times(&free, &x);
            } else {
                substitute(&pivots[i], &mut x);
            }
            for (row, x) in follows[i].iter_mut().zip(x) {
                row[ACTING] = x;
            }
            if let Some(after) = after {
                let lower = couplings.get(i).map_or(&after.stiffness, |coupling| &coupling.lower);
                earlier = pair(times(lower, &x)) - pull;
            }
        }
        put_together(resists, follows, ACTING, steps);
    }
}

/// Each node's step from that of the one after it.
#[inline(always)]
fn put_together<R: Real>(
    resists: &[Resists<R>],
    follows: &[Block<R>],
    column: usize,
    steps: &mut [Vec6<Vec3<R>>],
) {
    let mut x = [R::zero(); 6];
    for i in (0..follows.len()).rev() {
        let mut next = times(&follows[i], &x);
        for (next, row) in next.iter_mut().zip(&follows[i]) {
            *next += row[column];
        }
        steps[i] = match resists.get(i) {
            Some(after) => seen_from_near(&after.arm, pair(next)),
            None => pair(next),
        };
        x = parts(steps[i]);
    }
}

/// The product of the first six columns of a block with numbers.
#[inline(always)]
pub(super) fn times<R: Real, const COLUMNS: usize>(a: &[[R; COLUMNS]; 6], x: &[R; 6]) -> [R; 6] {
    let mut out = [R::zero(); 6];
    for (out, a) in out.iter_mut().zip(a) {
        *out = (a[0] * x[0] + a[1] * x[1]) + (a[2] * x[2] + a[3] * x[3]) + (a[4] * x[4] + a[5] * x[5]);
    }
    out
}

/// A variation seen from a place `arm` further on, seen from here.
#[inline(always)]
pub(super) fn seen_from_near<R: Real>(arm: &Vec3<R>, x: Vec6<Vec3<R>>) -> Vec6<Vec3<R>> {
    Vec6::new(x.angular, x.linear + arm.cross(x.angular))
}

/// Takes the equations of a node's variation, seen from its place, for those seen from a place `arm` further on: of the pivot `T⁻ᵀ P T⁻¹` with
/// `T (θ, s) = (θ, s + θ × arm)`, of what acts `T⁻ᵀ b`.
#[inline(always)]
fn see_from<R: Real>(arm: &Vec3<R>, pivot: &mut Square<R>, right: &mut Block<R>) {
    see_columns_from(arm, pivot);
    for c in 0..6 {
        let [a, b, d] = crossed(arm, pivot[3][c], pivot[4][c], pivot[5][c]);
        pivot[0][c] -= a;
        pivot[1][c] -= b;
        pivot[2][c] -= d;
    }
    for c in [ACTING, OTHER] {
        let [a, b, d] = crossed(arm, right[3][c], right[4][c], right[5][c]);
        right[0][c] -= a;
        right[1][c] -= b;
        right[2][c] -= d;
    }
}

/// `P T⁻¹`.
#[inline(always)]
pub(super) fn see_columns_from<R: Real>(arm: &Vec3<R>, pivot: &mut Square<R>) {
    for row in pivot {
        let [a, b, d] = crossed(arm, row[3], row[4], row[5]);
        row[0] -= a;
        row[1] -= b;
        row[2] -= d;
    }
}

#[inline(always)]
fn crossed<R: Real>(arm: &Vec3<R>, x: R, y: R, z: R) -> [R; 3] {
    [arm.y * z - arm.z * y, arm.z * x - arm.x * z, arm.x * y - arm.y * x]
}

/// A block that resists a variation seen from some place, for that seen from a place `arm` further on.
#[inline(always)]
pub(super) fn block_from(arm: &Vec3, block: &Square<f64>) -> Square<f64> {
    let (mut moved, mut none) = (*block, [[0.0; 8]; 6]);
    see_from(arm, &mut moved, &mut none);
    moved
}

#[inline(always)]
pub(super) fn parts<R: Real>(v: Vec6<Vec3<R>>) -> [R; 6] {
    [v.angular.x, v.angular.y, v.angular.z, v.linear.x, v.linear.y, v.linear.z]
}

#[inline(always)]
pub(super) fn pair<R: Real>(a: [R; 6]) -> Vec6<Vec3<R>> {
    Vec6::new(Vec3::new(a[0], a[1], a[2]), Vec3::new(a[3], a[4], a[5]))
}

#[inline(always)]
pub(super) fn add<R: Real>(to: &mut Square<R>, block: &Square<R>) {
    for r in 0..6 {
        for c in 0..6 {
            to[r][c] += block[r][c];
        }
    }
}

#[inline(always)]
pub(super) fn subtract<R: Real, const COLUMNS: usize>(from: &mut Square<R>, block: &[[R; COLUMNS]; 6]) {
    for r in 0..6 {
        for c in 0..6 {
            from[r][c] -= block[r][c];
        }
    }
}

/// Subtracts how the moment about a place of a dead force there changes with a shift of that: `−f^`.
#[inline(always)]
pub(super) fn subtract_dead_moment_slope<R: Real>(from: &mut Square<R>, force: Vec3<R>) {
    minus_hat(from, 0, 3, -force);
}

/// `F + A`: how what the element exerts on its far node changes with that node.
#[inline(always)]
pub(super) fn on_far<R: Real>(stiffness: &Square<R>, carried: Wrench<Vec3<R>>) -> Square<R> {
    let mut block = *stiffness;
    add_coadjoint(&mut block, carried);
    block
}

#[inline(always)]
pub(super) fn subtract_inertial_slopes<R: Real>(
    from: &mut Square<R>,
    [by_turn, by_shift]: &[Mat3<Vec3<R>>; 2],
) {
    for c in 0..3 {
        let (turn, shift) = (by_turn.cols[c], by_shift.cols[c]);
        from[0][c] -= turn.x;
        from[1][c] -= turn.y;
        from[2][c] -= turn.z;
        from[3][3 + c] -= shift.x;
        from[4][3 + c] -= shift.y;
        from[5][3 + c] -= shift.z;
    }
}

/// Adds `ad*(η) w` as a matrix of `η`, as [`coadjoint_by_strain`](crate::element::coadjoint_by_strain).
#[inline(always)]
pub(super) fn add_coadjoint<R: Real>(to: &mut Square<R>, w: Wrench<Vec3<R>>) {
    minus_hat(to, 0, 0, w.angular);
    minus_hat(to, 0, 3, w.linear);
    minus_hat(to, 3, 0, w.linear);
}

/// Adds `−v^` from a row and a column on.
#[inline(always)]
fn minus_hat<R: Real>(block: &mut Square<R>, r: usize, c: usize, v: Vec3<R>) {
    block[r][c + 1] += v.z;
    block[r][c + 2] -= v.y;
    block[r + 1][c] -= v.z;
    block[r + 1][c + 2] += v.x;
    block[r + 2][c] += v.y;
    block[r + 2][c + 1] -= v.x;
}

/// The drag on a node that turns and shifts: `|s|² + TURNING |θ|²`.
#[inline(always)]
fn add_drag<R: Real>(pivot: &mut Square<R>, drag: R) {
    for r in 0..3 {
        pivot[r][r] += drag * R::splat(TURNING);
        pivot[3 + r][3 + r] += drag;
    }
}

/// Solves the six equations for as many right-hand sides, in place, without interchange: the signs of the pivots are wanted, and where all are
/// positive it is not needed. Leaves the factors: by what of a row before each row is lessened, the rest of the rows, and the pivots' reciprocals.
#[inline(always)]
fn reduce<R: Real>(left: &mut Square<R>, right: &mut Block<R>, columns: usize, inertia: &mut Inertia<R>) {
    let mut size = R::zero();
    for k in 0..6 {
        size += left[k][k].abs();
    }
    let smallest = size * R::splat(SMALLEST_PIVOT);
    let (one, none) = (R::one(), R::zero());
    let mut scales = [none; 6];
    for k in 0..6 {
        let pivot = left[k][k];
        inertia.negative += R::select(pivot.at_most(0.0), one, none);
        // Not a number counts as vanished too.
        inertia.vanished += R::select((smallest - pivot.abs()).at_most(0.0), none, one);
        scales[k] = one / pivot;
        for i in k + 1..6 {
            let factor = left[i][k] * scales[k];
            for c in k + 1..6 {
                left[i][c] -= left[k][c] * factor;
            }
            if R::LANES == 1 {
                for c in 0..8 {
                    right[i][c] -= right[k][c] * factor;
                }
            }
            left[i][k] = factor;
        }
        left[k][k] = scales[k];
    }
    if R::LANES == 1 {
        for k in (0..6).rev() {
            for c in 0..8 {
                right[k][c] = right[k][c] * scales[k];
            }
            for i in 0..k {
                for c in 0..8 {
                    right[i][c] -= right[k][c] * left[i][k];
                }
            }
        }
        return;
    }
    // A number alone takes a row to a register; where each has one, a column stays in six of them.
    for c in 0..columns {
        let mut x = column(right, c);
        substitute(left, &mut x);
        for k in 0..6 {
            right[k][c] = x[k];
        }
    }
}

/// Solves six equations by the factors that [`reduce`] leaves.
#[inline(always)]
fn substitute<R: Real>(factors: &Square<R>, x: &mut [R; 6]) {
    for k in 0..6 {
        for i in k + 1..6 {
            x[i] -= x[k] * factors[i][k];
        }
    }
    for k in (0..6).rev() {
        x[k] = x[k] * factors[k][k];
        for i in 0..k {
            x[i] -= x[k] * factors[i][k];
        }
    }
}

/// What an eliminated node takes from the pivot after it and adds to what acts there: with `D` its pivot, `U` what stands beside that, `b` what acts and
/// `L` how what acts on the next node changes with it (the element's stiffness, and what couples momenta), `L D⁻¹ U` (of one rod its negative) and `L D⁻¹ b`.
#[inline(always)]
fn to_next<R: Real>(lower: &Square<R>, follow: &Block<R>, columns: usize, next: &mut Block<R>) {
    if R::LANES == 1 {
        multiply(lower, follow, next);
        for row in next {
            for x in &mut row[..ACTING] {
                *x = -*x;
            }
        }
        return;
    }
    for c in 0..columns {
        put_product(lower, column(follow, c), next, c);
    }
}

/// The product of a block with another, or with one and what stands beside it.
#[inline(always)]
pub(super) fn product<R: Real, const COLUMNS: usize>(
    a: &Square<R>,
    b: &[[R; COLUMNS]; 6],
) -> [[R; COLUMNS]; 6] {
    let mut out = [[R::zero(); COLUMNS]; 6];
    multiply(a, b, &mut out);
    out
}

/// The same in place.
#[inline(always)]
fn multiply<R: Real, const COLUMNS: usize>(
    a: &Square<R>,
    b: &[[R; COLUMNS]; 6],
    out: &mut [[R; COLUMNS]; 6],
) {
    if R::LANES == 1 {
        for (out, a) in out.iter_mut().zip(a) {
            for c in 0..COLUMNS {
                let term = |k: usize| b[k][c] * a[k];
                out[c] = (term(0) + term(1)) + (term(2) + term(3)) + (term(4) + term(5));
            }
        }
        return;
    }
    for c in 0..COLUMNS {
        put_product(a, column(b, c), out, c);
    }
}

/// Makes a column the product of a block with one that stays in registers.
#[inline(always)]
fn put_product<R: Real, const COLUMNS: usize>(
    a: &Square<R>,
    x: [R; 6],
    out: &mut [[R; COLUMNS]; 6],
    c: usize,
) {
    for (out, a) in out.iter_mut().zip(a) {
        out[c] = (x[0] * a[0] + x[1] * a[1]) + (x[2] * a[2] + x[3] * a[3]) + (x[4] * a[4] + x[5] * a[5]);
    }
}

#[inline(always)]
fn column<R: Real, const COLUMNS: usize>(block: &[[R; COLUMNS]; 6], c: usize) -> [R; 6] {
    [block[0][c], block[1][c], block[2][c], block[3][c], block[4][c], block[5][c]]
}

#[inline(always)]
pub(super) fn transposed<R: Real>(a: &Square<R>) -> Square<R> {
    core::array::from_fn(|r| core::array::from_fn(|c| a[c][r]))
}

/// Turns a held node's equations into such for its free displacements; those that are fixed are zero.
struct Restrict<'a, R> {
    hold: &'a Hold<R>,
    after: Option<&'a Resists<R>>,
    pivot: &'a mut Square<R>,
    right: &'a mut Block<R>,
}

impl<R: Real> Kernel for Restrict<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { hold, after, pivot, right } = self;
        let free = hold.free_seen_from(after);
        let t = transposed(&free);
        *right = product(&t, right);
        let held = product(&t, &product(pivot, &free));
        for r in 0..6 {
            for c in 0..6 {
                pivot[r][c] = held[r][c] + hold.curved[r][c];
            }
            pivot[r][r] += hold.fixed[r];
        }
    }
}

/// From the free displacements of a held node to the variation of its frame.
struct Expand<'a, R> {
    hold: &'a Hold<R>,
    after: Option<&'a Resists<R>>,
    follow: &'a mut Block<R>,
}

impl<R: Real> Kernel for Expand<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        *self.follow = product(&self.hold.free_seen_from(self.after), self.follow);
    }
}

impl<R: Real> Hold<R> {
    /// The free displacements, seen from the far end of the element after the node.
    #[inline(always)]
    fn free_seen_from(&self, after: Option<&Resists<R>>) -> Square<R> {
        let mut free = self.free;
        if let Some(Resists { arm, .. }) = after {
            for c in 0..6 {
                let [a, b, d] = crossed(arm, free[0][c], free[1][c], free[2][c]);
                free[3][c] -= a;
                free[4][c] -= b;
                free[5][c] -= d;
            }
        }
        free
    }
}
