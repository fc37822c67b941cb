//! Order of the steps in a search for shortest paths.

use core::cmp::Ordering;

/// A path length with the place that it leads to, for a `BinaryHeap` that pops the shortest first (Dijkstra 1959); of
/// equal lengths, the one to the lesser place.
///
/// ```
/// use geom::Step;
/// let mut heap = std::collections::BinaryHeap::from([Step(2.0, 7), Step(0.5, 3), Step(0.5, 4)]);
/// assert_eq!(heap.pop(), Some(Step(0.5, 3)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<T>(pub f64, pub T);

impl<T: Ord> Eq for Step<T> {}

impl<T: Ord> PartialOrd for Step<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T: Ord> Ord for Step<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}
