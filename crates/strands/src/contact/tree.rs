//! Which of many boxes overlap one.

use super::Aabb;

/// So many boxes at most stand in a leaf.
const LEAF: usize = 4;

/// A tree of boxes: each node's is about those of its two children.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree {
    /// The boxes' numbers, leaf after leaf.
    order: Vec<u32>,
    boxes: Vec<Aabb>,
    nodes: Vec<Node>,
}

/// Its children are the next node and another one, or it is a leaf of some boxes.
#[derive(Clone, Copy, Debug)]
struct Node {
    about: Aabb,
    /// The other child, or none.
    other: u32,
    first: u32,
    last: u32,
}

impl Tree {
    /// Puts boxes into it, in place of those that were.
    pub fn plant(&mut self, boxes: &[Aabb]) {
        self.order.clear();
        self.order.extend(0..boxes.len() as u32);
        self.nodes.clear();
        if !boxes.is_empty() {
            self.split(boxes, 0, boxes.len());
        }
        self.boxes.clear();
        self.boxes.extend(self.order.iter().map(|at| boxes[*at as usize]));
    }

    /// Halves some of them where their middles are spread most.
    fn split(&mut self, boxes: &[Aabb], first: usize, last: usize) {
        let order = &mut self.order[first..last];
        let about =
            order[1..].iter().fold(boxes[order[0] as usize], |all, at| all.with(&boxes[*at as usize]));
        let at = self.nodes.len();
        self.nodes.push(Node { about, other: 0, first: first as u32, last: last as u32 });
        if last - first <= LEAF {
            return;
        }
        let middles = order.iter().map(|at| boxes[*at as usize].middle());
        let (mut least, mut greatest) = (about.greatest, about.least);
        for middle in middles {
            least = least.min(middle);
            greatest = greatest.max(middle);
        }
        let spread = (greatest - least).to_array();
        let axis = (0..3).fold(0, |most, k| if spread[k] > spread[most] { k } else { most });
        let middle = |at: &u32| boxes[*at as usize].middle().to_array()[axis];
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
        self.split(boxes, first, first + half);
        self.nodes[at].other = self.nodes.len() as u32;
        self.split(boxes, first + half, last);
    }

    /// Finds the numbers of all boxes that overlap one.
    pub fn overlapping(&self, aabb: &Aabb, mut found: impl FnMut(usize)) {
        let mut waiting = [0_u32; 64];
        let mut left = usize::from(!self.nodes.is_empty());
        while left > 0 {
            left -= 1;
            let at = waiting[left];
            let node = &self.nodes[at as usize];
            if !node.about.overlaps(aabb) {
                continue;
            }
            if node.other > 0 {
                waiting[left] = at + 1;
                waiting[left + 1] = node.other;
                left += 2;
                continue;
            }
            for k in node.first as usize..node.last as usize {
                if self.boxes[k].overlaps(aabb) {
                    found(self.order[k] as usize);
                }
            }
        }
    }
}
