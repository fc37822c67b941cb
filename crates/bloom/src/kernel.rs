//! The inner loop of free-form deformation: eight points at a time.
//!
//! Each weight row lacks its first weight, as the weights of an axis sum to 1: `sum w_i P_i` is
//! `P_0 + sum w_i (P_i - P_0)` over i >= 1, which saves a quarter of the work of a cubic lattice. No fused
//! multiply-add: AVX-512, AVX2 and the plain form give the same bits.

use glam::DVec3;

/// Points in a block.
pub(crate) const LANES: usize = 8;

type Lane = [f64; LANES];

/// Numbers stored for a point.
pub(crate) fn weights_per_point(counts: [usize; 3]) -> usize {
    counts.iter().map(|c| c - 1).sum()
}

/// Deforms the points of whole blocks; `out` may be shorter than the last block.
pub(crate) fn deform(counts: [usize; 3], control: &[DVec3], weights: &[f64], out: &mut [DVec3]) {
    let steps = differences(counts, control);
    #[cfg(target_arch = "x86_64")]
    {
        if std::arch::is_x86_feature_detected!("avx512f") {
            #[expect(
                unsafe_code,
                reason = "the processor has AVX-512, as was just asked; halves the time of AVX2"
            )]
            // SAFETY: the feature is there.
            return unsafe { deform_avx512(counts, &steps, weights, out) };
        }
        if std::arch::is_x86_feature_detected!("avx2") {
            #[expect(unsafe_code, reason = "the processor has AVX2, as was just asked; halves the time")]
            // SAFETY: the feature is there.
            return unsafe { deform_avx2(counts, &steps, weights, out) };
        }
    }
    dispatch(counts, &steps, weights, out);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn deform_avx512(counts: [usize; 3], steps: &[[f64; 3]], weights: &[f64], out: &mut [DVec3]) {
    dispatch(counts, steps, weights, out);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn deform_avx2(counts: [usize; 3], steps: &[[f64; 3]], weights: &[f64], out: &mut [DVec3]) {
    dispatch(counts, steps, weights, out);
}

/// Control points as differences to the first of their row, plane and block, so that the loop only adds.
fn differences([l, m, n]: [usize; 3], control: &[DVec3]) -> Vec<[f64; 3]> {
    let mut d: Vec<DVec3> = control.to_vec();
    for i in 1..l {
        for r in 0..m * n {
            d[i * m * n + r] -= control[r];
        }
    }
    for i in 0..l {
        for j in (1..m).rev() {
            for k in 0..n {
                let first = d[i * m * n + k];
                d[(i * m + j) * n + k] -= first;
            }
        }
        for j in 0..m {
            let first = d[(i * m + j) * n];
            d[(i * m + j) * n + 1..(i * m + j + 1) * n].iter_mut().for_each(|p| *p -= first);
        }
    }
    d.into_iter().map(DVec3::into).collect()
}

// Constant counts let the compiler unroll; these three are what people use.
#[inline(always)]
fn dispatch(counts: [usize; 3], steps: &[[f64; 3]], weights: &[f64], out: &mut [DVec3]) {
    match counts {
        [4, 4, 4] => blocks([4, 4, 4], steps, weights, out),
        [3, 3, 3] => blocks([3, 3, 3], steps, weights, out),
        [5, 5, 5] => blocks([5, 5, 5], steps, weights, out),
        _ => blocks(counts, steps, weights, out),
    }
}

#[inline(always)]
fn add_scaled(sum: &mut [Lane; 3], w: &Lane, p: &[Lane; 3]) {
    for (s, p) in sum.iter_mut().zip(p) {
        for k in 0..LANES {
            s[k] += w[k] * p[k];
        }
    }
}

#[inline(always)]
fn blocks([l, m, n]: [usize; 3], steps: &[[f64; 3]], weights: &[f64], out: &mut [DVec3]) {
    let per_point = l + m + n - 3;
    let (lanes, _) = weights.as_chunks::<LANES>();
    for (block, out) in lanes.chunks_exact(per_point).zip(out.chunks_mut(LANES)) {
        let (ws, rest) = block.split_at(l - 1);
        let (wt, wu) = rest.split_at(m - 1);
        let mut whole = [[0.0; LANES]; 3];
        for i in 0..l {
            let mut plane = [[0.0; LANES]; 3];
            for j in 0..m {
                let row = &steps[(i * m + j) * n..(i * m + j) * n + n];
                let mut line = row[0].map(|x| [x; LANES]);
                for k in 1..n {
                    add_scaled(&mut line, &wu[k - 1], &row[k].map(|x| [x; LANES]));
                }
                if j == 0 {
                    plane = line;
                } else {
                    add_scaled(&mut plane, &wt[j - 1], &line);
                }
            }
            if i == 0 {
                whole = plane;
            } else {
                add_scaled(&mut whole, &ws[i - 1], &plane);
            }
        }
        for (lane, p) in out.iter_mut().enumerate() {
            *p = DVec3::new(whole[0][lane], whole[1][lane], whole[2][lane]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        for counts in [[4, 4, 4], [2, 5, 3], [3, 3, 3]] {
            let n: usize = counts.iter().product();
            let wild = |i: usize| base::ops::sin(i as f64 * 12.9898) * 43.7;
            let control: Vec<DVec3> =
                (0..n).map(|i| DVec3::new(wild(i), wild(i + 999), wild(i + 5555))).collect();
            let weights: Vec<f64> =
                (0..5 * LANES * weights_per_point(counts)).map(|i| wild(i + 7) * 0.01).collect();
            let mut fast = vec![DVec3::ZERO; 5 * LANES - 3];
            let mut plain = fast.clone();
            deform(counts, &control, &weights, &mut fast);
            dispatch(counts, &differences(counts, &control), &weights, &mut plain);
            assert_eq!(fast, plain, "{counts:?}");
        }
    }
}
