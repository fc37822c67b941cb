//! The inner loop of free-form deformation: eight points at a time.
//!
//! Only the three coordinates of a point are stored: computing its weights again in registers costs less than fetching
//! them from memory. As the weights of an axis sum to 1, `sum w_i P_i` is `P_0 + sum w_i (P_i - P_0)` over i >= 1,
//! which saves a quarter of the work of a cubic lattice. No fused multiply-add: AVX-512, AVX2 and the plain form give
//! the same bits. Vectors are explicit and not left to the compiler: from the plain form it makes code that is five
//! times slower.

use glam::DVec3;

/// Points in a block.
pub(crate) const LANES: usize = 8;

type Lane = [f64; LANES];

/// s, t and u of eight points.
pub(crate) type Stu = [Lane; 3];

/// Most control points along an axis.
pub(crate) const MOST: usize = 16;

/// Deforms the points of blocks by the [`differences`] of a lattice; `out` may be shorter than the last block.
pub(crate) fn deform(counts: [usize; 3], steps: &[[f64; 3]], blocks: &[Stu], out: &mut [DVec3]) {
    #[cfg(target_arch = "x86_64")]
    {
        if std::arch::is_x86_feature_detected!("avx512f") {
            #[expect(
                unsafe_code,
                reason = "the processor has AVX-512, as was just asked; a fifth of the time"
            )]
            // SAFETY: the feature is available.
            return unsafe { avx512::dispatch(counts, steps, blocks, out) };
        }
        if std::arch::is_x86_feature_detected!("avx2") {
            #[expect(
                unsafe_code,
                reason = "the processor has AVX2, as was just asked; a third of the time"
            )]
            // SAFETY: the feature is available.
            return unsafe { avx2::dispatch(counts, steps, blocks, out) };
        }
    }
    plain::dispatch(counts, steps, blocks, out);
}

/// Returns control points as differences to the first of their row, plane and block, so that the loop only adds.
pub(crate) fn differences([l, m, n]: [usize; 3], control: &[DVec3]) -> Vec<[f64; 3]> {
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

/// Defines the loop over `$parts` vectors of `LANES / $parts` numbers per block, for one set of instructions.
macro_rules! loops {
    ($(#[$feature:meta])? $parts:literal, $vector:ty) => {
        type Block = [$vector; $parts];

        $(#[$feature])?
        #[inline]
        fn add_scaled(sum: &mut [Block; 3], w: &Block, p: &[Block; 3]) {
            for (s, p) in sum.iter_mut().zip(p) {
                for k in 0..$parts {
                    s[k] = add(s[k], mul(w[k], p[k]));
                }
            }
        }

        $(#[$feature])?
        #[inline]
        fn spread(p: &[f64; 3]) -> [Block; 3] {
            [[splat(p[0]); $parts], [splat(p[1]); $parts], [splat(p[2]); $parts]]
        }

        /// Evaluates the Bernstein polynomials of degree `count - 1` at `x` by de Casteljau's recurrence: stable for
        /// any degree.
        $(#[$feature])?
        #[inline]
        fn bernstein(count: usize, x: Block, out: &mut [Block; MOST]) {
            let mut rest = x;
            for r in &mut rest {
                *r = sub(splat(1.0), *r);
            }
            out[0] = rest;
            out[1] = x;
            for degree in 2..count {
                let mut carry = [splat(0.0); $parts];
                for w in out.iter_mut().take(degree) {
                    for k in 0..$parts {
                        let before = w[k];
                        w[k] = add(carry[k], mul(before, rest[k]));
                        carry[k] = mul(before, x[k]);
                    }
                }
                out[degree] = carry;
            }
        }

        /// Constant counts let the compiler unroll; 0 stands for the value in `counts`.
        $(#[$feature])?
        fn blocks<const L: usize, const M: usize, const N: usize>(
            counts: [usize; 3],
            steps: &[[f64; 3]],
            points: &[Stu],
            out: &mut [DVec3],
        ) {
            let l = if L > 0 { L } else { counts[0] };
            let m = if M > 0 { M } else { counts[1] };
            let n = if N > 0 { N } else { counts[2] };
            let mut weights = [[[splat(0.0); $parts]; MOST]; 3];
            for (point, out) in points.iter().zip(out.chunks_mut(LANES)) {
                bernstein(l, load(&point[0]), &mut weights[0]);
                bernstein(m, load(&point[1]), &mut weights[1]);
                bernstein(n, load(&point[2]), &mut weights[2]);
                let [ws, wt, wu] = &weights;
                let mut lines = steps.chunks_exact(n);
                let mut whole = [[splat(0.0); $parts]; 3];
                for i in 0..l {
                    let mut plane = whole;
                    for j in 0..m {
                        let Some((first, others)) = lines.next().and_then(<[_]>::split_first) else { return };
                        let mut line = spread(first);
                        for (step, w) in others.iter().zip(&wu[1..n]) {
                            add_scaled(&mut line, w, &spread(step));
                        }
                        if j == 0 {
                            plane = line;
                        } else {
                            add_scaled(&mut plane, &wt[j], &line);
                        }
                    }
                    if i == 0 {
                        whole = plane;
                    } else {
                        add_scaled(&mut whole, &ws[i], &plane);
                    }
                }
                let [x, y, z] = [store(whole[0]), store(whole[1]), store(whole[2])];
                for (lane, p) in out.iter_mut().enumerate() {
                    *p = DVec3::new(x[lane], y[lane], z[lane]);
                }
            }
        }

        $(#[$feature])?
        pub(super) fn dispatch(counts: [usize; 3], steps: &[[f64; 3]], points: &[Stu], out: &mut [DVec3]) {
            match counts {
                // The most common lattice.
                [4, 4, 4] => blocks::<4, 4, 4>(counts, steps, points, out),
                [3, 3, 3] => blocks::<3, 3, 3>(counts, steps, points, out),
                [5, 5, 5] => blocks::<5, 5, 5>(counts, steps, points, out),
                _ => blocks::<0, 0, 0>(counts, steps, points, out),
            }
        }
    };
}

mod plain {
    use super::{DVec3, LANES, Lane, MOST, Stu};

    fn splat(x: f64) -> f64 {
        x
    }

    fn add(a: f64, b: f64) -> f64 {
        a + b
    }

    fn sub(a: f64, b: f64) -> f64 {
        a - b
    }

    fn mul(a: f64, b: f64) -> f64 {
        a * b
    }

    fn load(lane: &Lane) -> Block {
        *lane
    }

    fn store(block: Block) -> Lane {
        block
    }

    loops!(8, f64);
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use core::arch::x86_64::{
        __m256d, _mm256_add_pd as add, _mm256_loadu_pd, _mm256_mul_pd as mul, _mm256_set1_pd as splat,
        _mm256_storeu_pd, _mm256_sub_pd as sub,
    };

    use super::{DVec3, LANES, Lane, MOST, Stu};

    #[target_feature(enable = "avx2")]
    #[inline]
    fn load(lane: &Lane) -> Block {
        let (halves, _) = lane.as_chunks::<4>();
        #[expect(unsafe_code, reason = "loading has no safe form")]
        // SAFETY: each half has four numbers; the load needs no alignment.
        [0, 1].map(|k| unsafe { _mm256_loadu_pd(halves[k].as_ptr()) })
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    fn store(block: Block) -> Lane {
        let mut out = [0.0; LANES];
        for (half, v) in out.as_chunks_mut::<4>().0.iter_mut().zip(block) {
            #[expect(unsafe_code, reason = "storing has no safe form")]
            // SAFETY: each half has four numbers; the store needs no alignment.
            unsafe {
                _mm256_storeu_pd(half.as_mut_ptr(), v);
            }
        }
        out
    }

    loops!(
        #[target_feature(enable = "avx2")]
        2,
        __m256d
    );
}

#[cfg(target_arch = "x86_64")]
mod avx512 {
    use core::arch::x86_64::{
        __m512d, _mm512_add_pd as add, _mm512_loadu_pd, _mm512_mul_pd as mul, _mm512_set1_pd as splat,
        _mm512_storeu_pd, _mm512_sub_pd as sub,
    };

    use super::{DVec3, LANES, Lane, MOST, Stu};

    #[target_feature(enable = "avx512f")]
    #[inline]
    fn load(lane: &Lane) -> Block {
        #[expect(unsafe_code, reason = "loading has no safe form")]
        // SAFETY: a lane has eight numbers; the load needs no alignment.
        [unsafe { _mm512_loadu_pd(lane.as_ptr()) }]
    }

    #[target_feature(enable = "avx512f")]
    #[inline]
    fn store([block]: Block) -> Lane {
        let mut out = [0.0; LANES];
        #[expect(unsafe_code, reason = "storing has no safe form")]
        // SAFETY: a lane has eight numbers; the store needs no alignment.
        unsafe {
            _mm512_storeu_pd(out.as_mut_ptr(), block);
        }
        out
    }

    loops!(
        #[target_feature(enable = "avx512f")]
        1,
        __m512d
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        for counts in [[4, 4, 4], [2, 5, 3], [3, 3, 3], [16, 2, 9]] {
            let n: usize = counts.iter().product();
            let wild = |i: usize| base::ops::sin(i as f64 * 12.9898) * 43.7;
            let control: Vec<DVec3> =
                (0..n).map(|i| DVec3::new(wild(i), wild(i + 999), wild(i + 5555))).collect();
            let point = |b: usize| [0, 9, 18].map(|a| core::array::from_fn(|k| wild(b * 77 + a + k) * 0.03));
            let points: Vec<Stu> = (0..5).map(point).collect();
            let steps = differences(counts, &control);
            let mut want = vec![DVec3::ZERO; 5 * LANES - 3];
            plain::dispatch(counts, &steps, &points, &mut want);
            let mut got = want.clone();
            got.fill(DVec3::NAN);
            deform(counts, &steps, &points, &mut got);
            assert_eq!(got, want, "{counts:?}");
            #[cfg(target_arch = "x86_64")]
            if std::arch::is_x86_feature_detected!("avx2") {
                got.fill(DVec3::NAN);
                #[expect(unsafe_code, reason = "the processor has AVX2, as was just asked")]
                // SAFETY: the feature is available.
                unsafe {
                    avx2::dispatch(counts, &steps, &points, &mut got);
                }
                assert_eq!(got, want, "{counts:?} with AVX2");
            }
        }
    }
}
