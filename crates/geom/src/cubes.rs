//! Sorts points into cubes, and thins them to few, evenly spread ones.

use glam::DVec3;

/// Sorts the finite points into cubes of edge `cell` (above 0): the cube of each as z, y, x from the lowest corner of
/// their box, with its index; by z, y, x, then index.
///
/// Cubes farther than 2^31 edges from that corner are merged with the last. Cost: linear if the box is full enough,
/// otherwise n log n.
pub fn cubes(points: &[DVec3], cell: f64) -> Vec<([i32; 3], u32)> {
    let low = points.iter().filter(|p| p.is_finite()).fold(DVec3::INFINITY, |a, &p| a.min(p));
    let mut most = [0_u64; 3];
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturation is wanted, numbers are not negative; indices are below 2^32 points"
    )]
    let mut keyed: Vec<([i32; 3], u32)> = points
        .iter()
        .enumerate()
        .filter(|(_, p)| p.is_finite())
        .map(|(i, &p)| {
            let c = (p - low) / cell;
            let cube = [c.z as i32, c.y as i32, c.x as i32];
            most.iter_mut().zip(cube).for_each(|(m, c)| *m = (*m).max(c as u64));
            (cube, i as u32)
        })
        .collect();
    let [_, wide, long] = most.map(|m| m + 1);
    let whole = most.iter().try_fold(1_u64, |n, m| n.checked_mul(m + 1)).filter(|n| *n < 1 << 60);
    match whole {
        // With fewer points sorting by comparison is as fast.
        Some(whole) if keyed.len() > 4096 => {
            #[expect(clippy::cast_sign_loss, reason = "not negative")]
            let number = |[z, y, x]: [i32; 3]| (z as u64 * wide + y as u64) * long + x as u64;
            by_digits(&mut keyed, whole, number);
        }
        _ => base::sort_by_key(&mut keyed, |&row| row),
    }
    keyed
}

/// Sorts by a number below `whole`, digit by digit from the lowest; equal numbers keep their order.
fn by_digits(keyed: &mut Vec<([i32; 3], u32)>, whole: u64, number: impl Fn([i32; 3]) -> u64) {
    const BITS: u32 = 11;
    let digit = |cube, shift: u32| ((number(cube) >> shift) & ((1 << BITS) - 1)) as usize;
    let mut other = vec![([0; 3], 0); keyed.len()];
    for shift in (0..u64::BITS - whole.leading_zeros()).step_by(BITS as usize) {
        let mut starts = vec![0_usize; 1 << BITS];
        keyed.iter().for_each(|k| starts[digit(k.0, shift)] += 1);
        let mut sum = 0;
        for s in &mut starts {
            sum += core::mem::replace(s, sum);
        }
        for k in &*keyed {
            let place = &mut starts[digit(k.0, shift)];
            other[*place] = *k;
            *place += 1;
        }
        core::mem::swap(keyed, &mut other);
    }
}

/// Returns the index of one point for each cube of edge `cell` (above 0), cube by cube: the one nearest to the mean of
/// the cube's points, so that a dense part weighs no more than a sparse one.
pub fn one_a_cube(points: &[DVec3], cell: f64) -> Vec<u32> {
    let keyed = cubes(points, cell);
    let mut out = Vec::new();
    for cube in keyed.chunk_by(|a, b| a.0 == b.0) {
        let at = |&(_, i): &([i32; 3], u32)| points[i as usize];
        let mean = cube.iter().map(at).sum::<DVec3>() / cube.len() as f64;
        let nearest =
            cube.iter().min_by(|a, b| at(a).distance_squared(mean).total_cmp(&at(b).distance_squared(mean)));
        out.extend(nearest.map(|&(_, i)| i));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sorting_by_digits_is_sorting() {
        let mut s = base::Seed::new(4).stream(base::Draw::Test);
        let points: Vec<DVec3> =
            (0..9000).map(|_| DVec3::new(s.uniform(), 40.0 * s.uniform(), s.uniform() * 1e-3)).collect();
        for cell in [0.3, 1e-3, 1e-9, 1e-300] {
            let keyed = cubes(&points, cell);
            assert!(keyed.is_sorted(), "cell {cell}");
            assert_eq!(keyed.len(), points.len(), "cell {cell}");
        }
    }

    #[test]
    fn one_point_a_cube_is_the_middle_one() {
        let p = [0.1, 0.2, 0.25, 5.2, 0.9].map(DVec3::splat);
        assert_eq!(one_a_cube(&p, 1.0), [2, 3]);
        assert_eq!(one_a_cube(&[DVec3::NAN], 1.0), Vec::<u32>::new());
    }
}
