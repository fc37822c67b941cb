//! Sorting routines that are compiled only once.
//!
//! The standard library's sorts are compiled anew for each comparison, at some 8 KB of machine code each: sixty of them
//! were a tenth of what a browser downloads. Here only the comparison itself is new at each call.

use core::cmp::Ordering;
use litemap::LiteMap;

/// Slices of at most this length are sorted in place.
const SHORT: usize = 16;

/// Sorts by a comparison; equal rows keep their order.
///
/// As `slice::sort_by`, with these differences: the rows move once, at the end, and a slice of more than 16 rows takes
/// 8 bytes of memory for each. For numbers there is [`sort_numbers`]; where sorting unordered rows dominates the time,
/// the sorts of the standard library are faster. If `compare` is not a total order, the resulting order is unspecified.
///
/// ```
/// let mut rows = ["three", "to", "be", "sorted"];
/// base::sort_by(&mut rows, |a, b| a.len().cmp(&b.len()));
/// assert_eq!(rows, ["to", "be", "three", "sorted"]);
/// ```
pub fn sort_by<T>(rows: &mut [T], mut compare: impl FnMut(&T, &T) -> Ordering) {
    if rows.len() <= SHORT {
        for end in 1..rows.len() {
            let mut at = end;
            while at > 0 && compare(&rows[at], &rows[at - 1]).is_lt() {
                rows.swap(at, at - 1);
                at -= 1;
            }
        }
        return;
    }
    let mut order = sorted_order(rows.len(), &mut |a, b| compare(&rows[a as usize], &rows[b as usize]));
    // Cycle by cycle, each place receives its row; the displaced row moves on to the place that the next one leaves.
    for first in 0..rows.len() {
        let mut to = first;
        loop {
            let from = core::mem::replace(&mut order[to], index(to)) as usize;
            if from == first {
                break;
            }
            rows.swap(to, from);
            to = from;
        }
    }
}

/// Sorts numbers by their [total order](f64::total_cmp).
///
/// ```
/// let mut numbers = [2.0, f64::NAN, -1.0];
/// base::sort_numbers(&mut numbers);
/// assert_eq!(numbers[..2], [-1.0, 2.0]);
/// ```
pub fn sort_numbers(numbers: &mut [f64]) {
    numbers.sort_unstable_by(f64::total_cmp);
}

/// Returns the median: of an even count the upper of the two middle numbers, `None` of an empty list.
///
/// ```
/// assert_eq!(base::median(vec![3.0, 1.0, 9.0, 2.0]), Some(3.0));
/// assert_eq!(base::median(vec![]), None);
/// ```
pub fn median(mut numbers: Vec<f64>) -> Option<f64> {
    sort_numbers(&mut numbers);
    numbers.get(numbers.len() / 2).copied()
}

/// Moves the first `n` rows of an order before the others; each part is unordered, but the last of the first part is in
/// its place.
///
/// As `select_nth_unstable_by`, compiled once for all callers. `n`: 1 to the number of rows.
pub fn first_of(rows: &mut [usize], n: usize, compare: &mut dyn FnMut(&usize, &usize) -> Ordering) {
    rows.select_nth_unstable_by(n - 1, compare);
}

/// A set as a map without values.
pub type Set<K> = LiteMap<K, ()>;

/// Makes a map of rows; of several with one key the last stays.
///
/// A sorted vector: a tree of the standard library adds four to twelve kilobytes for each kind of row to what a browser
/// downloads. Inserting a row after all others is immediate, inserting any other moves those behind it; so this is for
/// rows that come in order, or are few. `collect` would compile a sort for each kind of row: here the rows are inserted
/// one by one.
///
/// ```
/// assert_eq!(base::map_of([(2, 'b'), (1, 'a')])[&1], 'a');
/// ```
pub fn map_of<K: Ord, V>(rows: impl IntoIterator<Item = (K, V)>) -> LiteMap<K, V> {
    let mut map = LiteMap::new();
    for (key, value) in rows {
        map.insert(key, value);
    }
    map
}

/// Makes a set as [`map_of`] makes maps.
pub fn set_of<K: Ord>(keys: impl IntoIterator<Item = K>) -> Set<K> {
    map_of(keys.into_iter().map(|key| (key, ())))
}

/// Sorts by a key; rows of equal keys keep their order. As [`sort_by`].
pub fn sort_by_key<T, K: Ord>(rows: &mut [T], mut key: impl FnMut(&T) -> K) {
    sort_by(rows, |a, b| key(a).cmp(&key(b)));
}

/// Returns the numbers from 0 to `n` in the order of a comparison; equal ones keep their order.
///
/// Cost: n log r comparisons for rows that rise and fall in r runs; a drawn line, which has few, takes little more than
/// n.
///
/// ```
/// let heights = [1.5_f64, 0.5, 1.0];
/// let order = base::sorted_order(3, &mut |a, b| heights[a as usize].total_cmp(&heights[b as usize]));
/// assert_eq!(order, [1, 2, 0]);
/// ```
pub fn sorted_order(n: usize, compare: &mut dyn FnMut(u32, u32) -> Ordering) -> Vec<u32> {
    let mut order: Vec<u32> = (0..index(n)).collect();
    let mut ends = runs(&mut order, compare);
    let mut merged = Vec::with_capacity(n);
    while ends.len() > 1 {
        let (mut first, mut kept) = (0, Vec::with_capacity(ends.len().div_ceil(2)));
        merged.clear();
        for pair in ends.chunks(2) {
            let end = pair[pair.len() - 1];
            let (mut left, mut right) = (&order[first..pair[0]], &order[pair[0]..end]);
            while let ([a, lefts @ ..], [b, rights @ ..]) = (left, right) {
                if compare(*b, *a).is_lt() {
                    merged.push(*b);
                    right = rights;
                } else {
                    merged.push(*a);
                    left = lefts;
                }
            }
            merged.extend_from_slice(left);
            merged.extend_from_slice(right);
            kept.push(end);
            first = end;
        }
        core::mem::swap(&mut order, &mut merged);
        ends = kept;
    }
    order
}

/// Makes rising runs of at least [`SHORT`] rows, except for the last, and returns the end of each.
fn runs(order: &mut [u32], compare: &mut dyn FnMut(u32, u32) -> Ordering) -> Vec<usize> {
    let (n, mut ends, mut first) = (order.len(), Vec::new(), 0);
    while first < n {
        let mut end = first + 1;
        let falls = end < n && compare(order[end], order[first]).is_lt();
        while end < n && compare(order[end], order[end - 1]).is_lt() == falls {
            end += 1;
        }
        if falls {
            order[first..end].reverse();
        }
        // A run too short for a merge is extended by the rows that follow, by insertion.
        let least = (first + SHORT).min(n);
        while end < least {
            let mut at = end;
            while at > first && compare(order[at], order[at - 1]).is_lt() {
                order.swap(at, at - 1);
                at -= 1;
            }
            end += 1;
        }
        ends.push(end);
        first = end;
    }
    ends
}

#[expect(clippy::cast_possible_truncation, reason = "slices of more than 2^32 rows are not sorted here")]
const fn index(i: usize) -> u32 {
    debug_assert!(i <= u32::MAX as usize, "too many rows");
    i as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Draw, Seed};

    #[test]
    fn sorts_as_the_standard_library_does() {
        let mut stream = Seed::new(3).stream(Draw::Test);
        for n in (0..70).chain([1000, 4096]) {
            for kinds in [1.0, 3.0, 50.0, 1e9] {
                let rows: Vec<(u64, usize)> =
                    (0..n).map(|i| ((stream.uniform() * kinds).to_bits() >> 50, i)).collect();
                let (mut ours, mut theirs) = (rows.clone(), rows.clone());
                sort_by_key(&mut ours, |r| core::cmp::Reverse(r.0));
                theirs.sort_by_key(|r| core::cmp::Reverse(r.0));
                assert_eq!(ours, theirs, "{n} rows");
                sort_by(&mut ours, |a, b| a.1.cmp(&b.1));
                assert_eq!(ours, rows, "{n} rows by key");
                // Rises and falls, like a line drawn to and fro.
                let mut waves: Vec<(i64, usize)> = (0..n)
                    .map(|i| ((i as i64 % 60 - 30).abs() / 2 + (rows[i].0 % 3) as i64 / 2, i))
                    .collect();
                let mut theirs = waves.clone();
                sort_by_key(&mut waves, |r| r.0);
                theirs.sort_by_key(|r| r.0);
                assert_eq!(waves, theirs, "{n} rows in waves");
            }
        }
    }
}
