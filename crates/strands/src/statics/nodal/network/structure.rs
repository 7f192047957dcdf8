//! The order in which unknowns are eliminated, and which blocks that fills.

use core::cmp::Reverse;
use core::ops::Range;
use std::collections::BinaryHeap;

/// Which unknown follows from which.
#[derive(Clone, Debug, Default)]
pub(super) struct Structure {
    /// The unknowns after each that stand in its equations when it is its turn: where those of one begin in the list of all. The block of the two has the same number.
    pub begins: Vec<usize>,
    pub after: Vec<usize>,
    /// The same for each two of those, by their places in the list, and where the block of the first's row and the second's column is.
    pub pair_begins: Vec<usize>,
    pub pairs: Vec<[usize; 3]>,
}

impl Structure {
    /// From the pairs of unknowns that stand in each other's equations, each once and both ways. Gives also the place of each unknown in the order.
    pub fn new(unknowns: usize, edges: &[[usize; 2]]) -> (Self, Vec<usize>) {
        let mut beside: Vec<Vec<usize>> = vec![Vec::new(); unknowns];
        edges.iter().for_each(|[a, b]| beside[*a].push(*b));
        let mut waiting: BinaryHeap<Reverse<(usize, usize)>> =
            beside.iter().enumerate().map(|(unknown, beside)| Reverse((beside.len(), unknown))).collect();
        let mut place = vec![usize::MAX; unknowns];
        let mut order = Vec::with_capacity(unknowns);
        let mut joined = Vec::new();
        while let Some(Reverse((degree, unknown))) = waiting.pop() {
            if place[unknown] != usize::MAX || degree != beside[unknown].len() {
                continue;
            }
            place[unknown] = order.len();
            order.push(unknown);
            let left = core::mem::take(&mut beside[unknown]);
            for &a in &left {
                joined.clear();
                merge(&beside[a], &left, |b| {
                    if b != a && b != unknown {
                        joined.push(b);
                    }
                });
                beside[a].clone_from(&joined);
                waiting.push(Reverse((joined.len(), a)));
            }
            beside[unknown] = left;
        }
        let mut structure = Self::default();
        for unknown in &order {
            structure.begins.push(structure.after.len());
            let begin = structure.after.len();
            structure.after.extend(beside[*unknown].iter().map(|unknown| place[*unknown]));
            structure.after[begin..].sort_unstable();
        }
        structure.begins.push(structure.after.len());
        for p in 0..unknowns {
            structure.pair_begins.push(structure.pairs.len());
            let of = structure.range(p);
            for i in of.clone() {
                // All that come after this one stand in its row too.
                let row = structure.range(structure.after[i]);
                let mut at = row.start;
                for j in i + 1..of.end {
                    while structure.after[at] != structure.after[j] {
                        at += 1;
                    }
                    structure.pairs.push([i, j, at]);
                }
            }
        }
        structure.pair_begins.push(structure.pairs.len());
        (structure, place)
    }

    /// Where in the list the unknowns after one are.
    pub fn range(&self, unknown: usize) -> Range<usize> {
        self.begins[unknown]..self.begins[unknown + 1]
    }

    /// The number of the block of two unknowns, if there is one.
    pub fn find(&self, first: usize, second: usize) -> Option<usize> {
        let range = self.range(first);
        let at = self.after[range.clone()].binary_search(&second).ok()?;
        Some(range.start + at)
    }

    pub fn block(&self, first: usize, second: usize) -> usize {
        let block = self.find(first, second);
        block.unwrap_or_else(|| unreachable!("every pair that is added was foreseen"))
    }
}

/// All numbers of two sorted lists, each once.
fn merge(a: &[usize], b: &[usize], mut take: impl FnMut(usize)) {
    let (mut i, mut j) = (0, 0);
    while i < a.len() || j < b.len() {
        let next = match (a.get(i), b.get(j)) {
            (Some(a), Some(b)) => *a.min(b),
            (Some(a), None) | (None, Some(a)) => *a,
            (None, None) => return,
        };
        i += usize::from(a.get(i) == Some(&next));
        j += usize::from(b.get(j) == Some(&next));
        take(next);
    }
}
