//! The inner loops of the search for points near a new joint: the cells, then the groups of points.
//!
//! Eight numbers at a time. Everything that passes is tested exactly afterwards, so only time depends on these loops;
//! yet AVX2 and the plain form give the same bits, as neither fuses products and sums.

/// Points, or cells, that are filtered together.
pub(crate) const LANES: usize = 8;
/// Cells along a side of a block.
pub(crate) const SIDE: usize = 4;
/// Cells in a block.
pub(crate) const BLOCK: usize = SIDE * SIDE * SIDE;

type Lane = [f32; LANES];

/// Eight points, measured from the grid's corner, with upper bounds of their squared distances to their joints. Where
/// there is no point, the bound is minus infinity.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Sieve {
    pub(crate) x: Lane,
    pub(crate) y: Lane,
    pub(crate) z: Lane,
    pub(crate) best2: Lane,
}

/// No points.
pub(crate) const EMPTY: Sieve =
    Sieve { x: [0.0; LANES], y: [0.0; LANES], z: [0.0; LANES], best2: [f32::NEG_INFINITY; LANES] };

/// Position of a new joint, as in the sieve, and the error bound of a squared distance there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probe {
    pub(crate) at: [f32; 3],
    pub(crate) slack: f32,
}

/// A group of the sieve in which the lanes of these bits may be nearer to a new joint.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Near {
    pub(crate) group: u32,
    pub(crate) lanes: u32,
    pub(crate) cell: u32,
}

/// Cells to be filtered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cells<'a> {
    /// Their numbers.
    pub(crate) near: &'a [u32],
    /// First slot of every cell, a multiple of [`LANES`], and number of points in it.
    pub(crate) start: &'a [u32],
    pub(crate) left: &'a [u32],
    /// All slots.
    pub(crate) sieve: &'a [Sieve],
}

/// Calls the variant of a loop for this processor.
macro_rules! fastest {
    ($call:ident($($argument:expr),*)) => {{
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            #[expect(unsafe_code, reason = "the processor has AVX2, as was just asked; two thirds of the time")]
            // SAFETY: the feature is available.
            return unsafe { avx2::$call($($argument),*) };
        }
        plain::$call($($argument),*)
    }};
}

/// Returns a bit for each cell of a block whose reach, `reach2`, exceeds its distance: the sum of squared `gaps` by
/// axis.
#[inline]
pub(crate) fn near_in(reach2: &[f32; BLOCK], gaps: &[[f32; SIDE]; 3]) -> u64 {
    fastest!(near_in(reach2, gaps))
}

/// Filters cells: `found` receives the groups with points that may be nearer to the joint. Returns their number. There
/// must be room for all groups and one more.
#[inline]
pub(crate) fn near_groups(cells: Cells<'_>, probe: &Probe, found: &mut [Near]) -> usize {
    fastest!(near_groups(cells, probe, found))
}

/// Defines the loops for one set of instructions.
macro_rules! loops {
    ($(#[$feature:meta])?) => {
        $(#[$feature])?
        pub(super) fn near_in(reach2: &[f32; BLOCK], gaps: &[[f32; SIDE]; 3]) -> u64 {
            let [gx, gy, gz] = gaps;
            // Two adjacent rows of cells.
            let mut rows = [[0.0; LANES]; 2];
            for (n, gap) in rows.as_flattened_mut().iter_mut().enumerate() {
                *gap = gx[n % SIDE] + gy[n / SIDE];
            }
            let rows = [load(&rows[0]), load(&rows[1])];
            let mut near = 0;
            for (n, reach2) in reach2.as_chunks::<LANES>().0.iter().enumerate() {
                let bits = greater(load(reach2), add(rows[n % 2], splat(gz[n / 2])));
                near |= u64::from(bits) << (n * LANES);
            }
            near
        }

        $(#[$feature])?
        pub(super) fn near_groups(cells: Cells<'_>, probe: &Probe, found: &mut [Near]) -> usize {
            let [x, y, z] = probe.at;
            let (x, y, z, least) = (splat(x), splat(y), splat(z), splat(-probe.slack));
            let mut count = 0;
            for &cell in cells.near {
                let from = cells.start[cell as usize] as usize / LANES;
                let to = from + (cells.left[cell as usize] as usize).div_ceil(LANES);
                for (sieve, group) in cells.sieve[from..to].iter().zip(index(from)..) {
                    let (dx, dy, dz) = (sub(load(&sieve.x), x), sub(load(&sieve.y), y), sub(load(&sieve.z), z));
                    let d2 = add(add(mul(dx, dx), mul(dy, dy)), mul(dz, dz));
                    let lanes = greater(sub(load(&sieve.best2), d2), least);
                    found[count] = Near { group, lanes, cell };
                    count += usize::from(lanes != 0);
                }
            }
            count
        }
    };
}

mod plain {
    use glam::Vec4;

    use super::{BLOCK, Cells, LANES, Lane, Near, Probe, SIDE, index};

    type Eight = [Vec4; 2];

    fn load(lane: &Lane) -> Eight {
        let (halves, _) = lane.as_chunks::<4>();
        [Vec4::from_array(halves[0]), Vec4::from_array(halves[1])]
    }

    fn splat(x: f32) -> Eight {
        [Vec4::splat(x); 2]
    }

    fn add(a: Eight, b: Eight) -> Eight {
        [a[0] + b[0], a[1] + b[1]]
    }

    fn sub(a: Eight, b: Eight) -> Eight {
        [a[0] - b[0], a[1] - b[1]]
    }

    fn mul(a: Eight, b: Eight) -> Eight {
        [a[0] * b[0], a[1] * b[1]]
    }

    fn greater(a: Eight, b: Eight) -> u32 {
        a[0].cmpgt(b[0]).bitmask() | a[1].cmpgt(b[1]).bitmask() << 4
    }

    loops!();
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use core::arch::x86_64::{
        __m256, _CMP_GT_OQ, _mm256_add_ps as add, _mm256_cmp_ps, _mm256_loadu_ps, _mm256_movemask_ps,
        _mm256_mul_ps as mul, _mm256_set1_ps as splat, _mm256_sub_ps as sub,
    };

    use super::{BLOCK, Cells, LANES, Lane, Near, Probe, SIDE, index};

    #[target_feature(enable = "avx2")]
    #[inline]
    fn load(lane: &Lane) -> __m256 {
        #[expect(unsafe_code, reason = "loading has no safe form")]
        // SAFETY: a lane has eight numbers; the load needs no alignment.
        unsafe {
            _mm256_loadu_ps(lane.as_ptr())
        }
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    fn greater(a: __m256, b: __m256) -> u32 {
        _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(a, b)).cast_unsigned()
    }

    loops!(#[target_feature(enable = "avx2")]);
}

#[expect(clippy::cast_possible_truncation, reason = "more than 2^32 attractors do not fit in memory")]
const fn index(i: usize) -> u32 {
    i as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::{Draw, Seed};

    #[test]
    fn every_instruction_set_finds_the_same_as_one_number_at_a_time() {
        let mut s = Seed::new(7).stream(Draw::Test);
        #[expect(clippy::cast_possible_truncation, reason = "small")]
        let mut any = || s.uniform() as f32;
        for _ in 0..50 {
            let reach2: [f32; BLOCK] = core::array::from_fn(|_| any());
            let gaps: [[f32; SIDE]; 3] = core::array::from_fn(|_| core::array::from_fn(|_| any() * 0.5));
            let reaches = |c: usize| {
                let [x, y, z] = [c % SIDE, c / SIDE % SIDE, c / SIDE / SIDE];
                reach2[c] > gaps[0][x] + gaps[1][y] + gaps[2][z]
            };
            let want = (0..BLOCK).fold(0, |bits, c| bits | u64::from(reaches(c)) << c);
            assert_eq!((plain::near_in(&reach2, &gaps), near_in(&reach2, &gaps)), (want, want));

            let lane = |any: &mut dyn FnMut() -> f32| core::array::from_fn(|_| any());
            let sieve: Vec<Sieve> = (0..6)
                .map(|_| Sieve {
                    x: lane(&mut any),
                    y: lane(&mut any),
                    z: lane(&mut any),
                    best2: lane(&mut any),
                })
                .collect();
            // Cell 1 is empty, cell 2 is not requested.
            let cells =
                Cells { near: &[0, 1, 3], start: &[0, 16, 16, 32], left: &[9, 0, 12, 16], sieve: &sieve };
            let probe = Probe { at: [any(), any(), any()], slack: 0.01 };
            let near = |group: usize| {
                let Sieve { x, y, z, best2 } = sieve[group];
                let [dx, dy, dz] = [0, 1, 2].map(|axis| move |k: usize| [x, y, z][axis][k] - probe.at[axis]);
                let room = |k| best2[k] - (dx(k) * dx(k) + dy(k) * dy(k) + dz(k) * dz(k));
                (0..LANES).fold(0, |bits, k| bits | u32::from(room(k) > -probe.slack) << k)
            };
            let want: Vec<(usize, u32, u32)> = [(0, 0), (1, 0), (4, 3), (5, 3)]
                .map(|(group, cell)| (group, near(group), cell))
                .into_iter()
                .filter(|n| n.1 != 0)
                .collect();
            for sift in [plain::near_groups, near_groups] {
                let mut found = [Near::default(); 7];
                let count = sift(cells, &probe, &mut found);
                let got: Vec<_> =
                    found[..count].iter().map(|n| (n.group as usize, n.lanes, n.cell)).collect();
                assert_eq!(got, want);
            }
        }
    }
}
