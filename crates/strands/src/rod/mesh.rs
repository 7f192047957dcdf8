//! Where the nodes lie, and how a function along the rod is summed onto them.
//!
//! A rod is cut at its *breaks* (steps of section or rest shape, ends of loads, supports, point loads) into spans, and
//! each span into elements of equal length. Distributed loads are summed onto the nodes by a rule of the order of the
//! element: the trapezoidal rule, or for order 4 Simpson's (with its three-eighths rule for three elements of a span with an odd
//! number), which keeps the whole scheme at that order.

use super::RodError;
use core::ops::Range;

/// The order of accuracy of the discretisation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Order {
    /// The paper's Euler scheme, (9)–(16): an element takes the strain of its far node.
    First,
    /// Constant strain in an element, from the mean of the stress carried along it.
    #[default]
    Second,
    /// Linear strain in an element: two-point Gauss, fourth-order Magnus.
    Fourth,
}

impl Order {
    /// 1, 2 or 4.
    pub const fn as_number(self) -> usize {
        match self {
            Self::First => 1,
            Self::Second => 2,
            Self::Fourth => 4,
        }
    }

    /// The order of that number, where there is one.
    pub const fn from_number(number: usize) -> Option<Self> {
        match number {
            1 => Some(Self::First),
            2 => Some(Self::Second),
            4 => Some(Self::Fourth),
            _ => None,
        }
    }

    /// The places in an element, as parts of its length, at which its law and rest strain are taken.
    pub const fn places(self) -> &'static [f64] {
        /// `(1 ∓ 1/√3)/2`, the two Gauss points.
        const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
        match self {
            Self::First => &[1.0],
            Self::Second => &[0.5],
            Self::Fourth => &GAUSS,
        }
    }
}

/// The nodes of a rod.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    nodes: Vec<f64>,
    spans: Vec<Range<usize>>,
}

impl Mesh {
    /// Cuts `[0, length]` into `elements`, as even as the breaks allow: each span gets its share by length, at least one and, where it
    /// can, at least two.
    ///
    /// # Errors
    /// Where there are fewer elements than spans, or the length is not positive.
    pub fn even(length: f64, elements: usize, breaks: &[f64]) -> Result<Self, RodError> {
        RodError::positive("length", length)?;
        let cuts = cuts(length, breaks);
        let spans = cuts.len() - 1;
        if elements < spans {
            return Err(RodError::TooFewElements { elements, spans, needed: spans });
        }
        // Largest remainder, over a floor of one element a span.
        let least = if elements >= 2 * spans { 2 } else { 1 };
        let ideal = |i: usize| (cuts[i + 1] - cuts[i]) / length * elements as f64;
        let mut counts: Vec<usize> = (0..spans).map(|i| (ideal(i) as usize).max(least)).collect();
        while counts.iter().sum::<usize>() != elements {
            let total = counts.iter().sum::<usize>();
            let need = |i: usize| ideal(i) - counts[i] as f64;
            let by_need = |&i: &usize, &j: &usize| need(i).total_cmp(&need(j));
            if total < elements {
                let i = (0..spans).max_by(by_need).unwrap_or(0);
                counts[i] += 1;
            } else {
                let i = (0..spans).filter(|&i| counts[i] > least).min_by(by_need).unwrap_or(0);
                counts[i] -= 1;
            }
        }
        let pieces: Vec<(f64, usize)> = (0..spans).map(|i| (cuts[i + 1], counts[i])).collect();
        Self::from_pieces(&pieces)
    }

    /// Pieces end to end, each given by where it ends and how many equal elements it has.
    ///
    /// # Errors
    /// Where there is no piece, one has no element, or one does not end, at a finite place, after it starts.
    pub fn from_pieces(pieces: &[(f64, usize)]) -> Result<Self, RodError> {
        if pieces.is_empty() {
            return Err(RodError::TooFewPoints { what: "pieces of the mesh", needed: 1, got: 0 });
        }
        let mut mesh = Self { nodes: vec![0.0], spans: Vec::with_capacity(pieces.len()) };
        let mut start = 0.0;
        for &(end, elements) in pieces {
            if elements == 0 {
                return Err(RodError::TooFewPoints { what: "elements of a piece", needed: 1, got: 0 });
            }
            if !(end > start && end.is_finite()) {
                let expected = "a finite number greater than the end of the one before, or than zero";
                return Err(RodError::OutOfRange { quantity: "the end of a piece", value: end, expected });
            }
            let first = mesh.nodes.len() - 1;
            mesh.nodes.extend((1..elements).map(|i| start + (end - start) * i as f64 / elements as f64));
            mesh.nodes.push(end);
            mesh.spans.push(first..first + elements);
            start = end;
        }
        Ok(mesh)
    }

    /// The nodes' places, m from the start, growing; the first is 0 and the last the rod's length.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Stretches of equal elements, as ranges of elements.
    pub fn spans(&self) -> &[Range<usize>] {
        &self.spans
    }

    /// How many elements there are.
    pub fn elements(&self) -> usize {
        self.nodes.len() - 1
    }

    /// The node at `s`, where one lies there (to 1e-9 of the length).
    pub fn node_at(&self, s: f64) -> Option<usize> {
        let length = self.nodes[self.nodes.len() - 1];
        self.nodes.iter().position(|node| (node - s).abs() <= 1e-9 * length)
    }

    /// Sums a function of `s` onto the nodes: calls `add(node, s, towards, weight)` so that `Σ weight f(s)` is its integral over the
    /// elements that lie within `[from, to]`, each span's by one rule. `towards` is a place inside the span, which tells the sides of a jump
    /// apart.
    pub fn distribute(&self, order: Order, from: f64, to: f64, mut add: impl FnMut(usize, f64, f64, f64)) {
        let slack = 1e-9 * self.nodes[self.nodes.len() - 1];
        for span in &self.spans {
            let (start, end) = (self.nodes[span.start], self.nodes[span.end]);
            let h = (end - start) / span.len() as f64;
            let middle = 0.5 * (start + end);
            let within = |e: &usize| self.nodes[*e] >= from - slack && self.nodes[*e + 1] <= to + slack;
            let Some(first) = span.clone().find(within) else { continue };
            let count = (first..span.end).take_while(within).count();
            for (i, weight) in weights(order, count).into_iter().enumerate() {
                add(first + i, self.nodes[first + i], middle, weight * h);
            }
        }
    }
}

fn cuts(length: f64, breaks: &[f64]) -> Vec<f64> {
    let slack = 1e-9 * length;
    let mut cuts: Vec<f64> = breaks.iter().copied().filter(|s| *s > slack && *s < length - slack).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|a, b| *a - *b <= slack);
    cuts.insert(0, 0.0);
    cuts.push(length);
    cuts
}

/// The weights, over the element length, of the composite rule of a span with `n` elements.
fn weights(order: Order, n: usize) -> Vec<f64> {
    let mut w = vec![0.0; n + 1];
    let mut panel = |start: usize, rule: &[f64]| {
        for (i, weight) in rule.iter().enumerate() {
            w[start + i] += weight;
        }
    };
    if order == Order::Fourth && n >= 2 {
        let pairs_until = if n.is_multiple_of(2) { n } else { n - 3 };
        (0..pairs_until).step_by(2).for_each(|i| panel(i, &[1.0 / 3.0, 4.0 / 3.0, 1.0 / 3.0]));
        if pairs_until < n {
            panel(pairs_until, &[3.0 / 8.0, 9.0 / 8.0, 9.0 / 8.0, 3.0 / 8.0]);
        }
    } else {
        (0..n).for_each(|i| panel(i, &[0.5, 0.5]));
    }
    w
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_shared_by_length_and_the_breaks_are_nodes() {
        let mesh = Mesh::even(1.0, 10, &[0.35]).unwrap();
        assert_eq!(mesh.elements(), 10);
        assert!(mesh.node_at(0.35).is_some());
        assert_eq!(mesh.spans().len(), 2);
        assert!(Mesh::even(1.0, 1, &[0.5]).is_err());
    }

    #[test]
    fn pieces_that_are_no_mesh_are_refused() {
        let bad: [&[(f64, usize)]; 6] = [
            &[],
            &[(0.5, 0), (1.0, 5)],
            &[(0.5, 2), (0.4, 2)],
            &[(0.5, 2), (0.5, 2)],
            &[(0.0, 1)],
            &[(f64::NAN, 1)],
        ];
        for pieces in bad {
            assert!(Mesh::from_pieces(pieces).is_err(), "{pieces:?}");
        }
        let said = Mesh::from_pieces(&[(0.5, 2), (0.4, 2)]).unwrap_err().to_string();
        assert!(said.starts_with("the end of a piece is 0.4, but must be"), "{said}");
        assert_eq!(Mesh::from_pieces(&[(0.5, 1), (1.0, 2)]).unwrap().nodes(), [0.0, 0.5, 0.75, 1.0]);
    }

    #[test]
    fn the_rule_of_order_four_sums_cubics_exactly_for_any_number_of_elements() {
        for n in 2..12 {
            let mesh = Mesh::even(2.0, n, &[]).unwrap();
            let mut sum = 0.0;
            mesh.distribute(Order::Fourth, 0.0, 2.0, |_, s, _, w| sum += w * s.powi(3));
            assert!((sum - 4.0).abs() < 1e-13, "{n}: {sum}");
        }
    }
}
