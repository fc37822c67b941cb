//! The filters of `EXT_meshopt_compression`: elements are stored in another form than programs draw them.
//!
//! Each decodes the contents of a stream in place, as the extension's text says (it defines decoding, not encoding).

/// Name of [`Filter::Octahedral`].
pub(super) const OCTAHEDRAL: &str = "OCTAHEDRAL";
/// Name of [`Filter::Quaternion`].
pub(super) const QUATERNION: &str = "QUATERNION";
/// Name of [`Filter::Exponential`].
pub(super) const EXPONENTIAL: &str = "EXPONENTIAL";

/// Stored form of the elements of a stream of attributes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Filter {
    /// Unit vectors as two coordinates on an octahedron; 4 or 8 bytes an element.
    Octahedral,
    /// Unit quaternions as their three smaller components; 8 bytes an element.
    Quaternion,
    /// Floats as a whole number of 24 bits times a power of 2; 4 bytes each.
    Exponential,
}

impl Filter {
    /// Returns the filter of this name; `None` if the extension does not have it.
    pub(super) fn from_word(word: &str) -> Option<Self> {
        match word {
            OCTAHEDRAL => Some(Self::Octahedral),
            QUATERNION => Some(Self::Quaternion),
            EXPONENTIAL => Some(Self::Exponential),
            _ => None,
        }
    }

    /// Decodes elements in place; `None` if elements of `stride` bytes cannot have this form.
    pub(super) fn decode(self, bytes: &mut [u8], stride: usize) -> Option<()> {
        match (self, stride) {
            (Self::Octahedral, 4) => bytes.chunks_exact_mut(4).for_each(|e| {
                let [x, y, one, w] = [0, 1, 2, 3].map(|k| i8::from_le_bytes([e[k]]));
                let [x, y, z] = on_sphere([x, y, one].map(f64::from), 127.0);
                #[expect(clippy::cast_possible_truncation, reason = "-127 to 127")]
                let whole = [x as i8, y as i8, z as i8, w];
                e.copy_from_slice(&whole.map(|v| v.to_le_bytes()[0]));
            }),
            (Self::Octahedral, 8) => bytes.chunks_exact_mut(8).for_each(|e| {
                let [x, y, one, w] = words(e);
                let [x, y, z] = on_sphere([x, y, one].map(f64::from), 32_767.0);
                #[expect(clippy::cast_possible_truncation, reason = "-32,767 to 32,767")]
                put(e, [x as i16, y as i16, z as i16, w]);
            }),
            (Self::Quaternion, 8) => bytes.chunks_exact_mut(8).for_each(|e| {
                let [x, y, z, scale] = words(e);
                let (one, largest) = (f64::from(scale | 3), usize::try_from(scale & 3).unwrap_or(0));
                let [x, y, z] = [x, y, z].map(|v| f64::from(v) / one * core::f64::consts::FRAC_1_SQRT_2);
                let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
                #[expect(clippy::cast_possible_truncation, reason = "clamped by the cast itself")]
                let whole = [w, x, y, z].map(|v| (v * 32_767.0).round() as i16);
                let mut turned = [0; 4];
                (0..4).for_each(|k| turned[(largest + k) % 4] = whole[k]);
                put(e, turned);
            }),
            (Self::Exponential, _) if stride.is_multiple_of(4) => bytes.chunks_exact_mut(4).for_each(|e| {
                let stored = i32::from_le_bytes([e[0], e[1], e[2], e[3]]);
                let (power, whole) = (stored >> 24, stored << 8 >> 8);
                #[expect(clippy::cast_possible_truncation, reason = "single precision is what is asked for")]
                let value = (f64::from(whole) * two_to(power)) as f32;
                e.copy_from_slice(&value.to_le_bytes());
            }),
            _ => return None,
        }
        Some(())
    }
}

/// Returns a power of two, with an exponent from -1022 to 1023.
fn two_to(power: i32) -> f64 {
    f64::from_bits(u64::from((1023 + power).unsigned_abs()) << 52)
}

fn words(element: &[u8]) -> [i16; 4] {
    [0, 2, 4, 6].map(|k| i16::from_le_bytes([element[k], element[k + 1]]))
}

fn put(element: &mut [u8], words: [i16; 4]) {
    for (to, word) in element.chunks_exact_mut(2).zip(words) {
        to.copy_from_slice(&word.to_le_bytes());
    }
}

/// Maps two coordinates on an octahedron with its half axis `one` to a vector of length `most`, in whole numbers.
fn on_sphere([x, y, one]: [f64; 3], most: f64) -> [f64; 3] {
    let one = if one == 0.0 { most } else { one };
    let (mut x, mut y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    let below = z.min(0.0);
    x += if x >= 0.0 { below } else { -below };
    y += if y >= 0.0 { below } else { -below };
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|v| (v / length * most).round())
}

/// Steps of half an axis of the octahedron that keep a vector to a degree.
pub(super) const FINE: i8 = 127;
/// Steps of half an axis of the octahedron that keep a vector to four degrees.
pub(super) const COARSE: i8 = 31;

/// Returns a unit vector as [`Filter::Octahedral`] stores it in four bytes: among the four pairs of whole numbers
/// around it the one that decodes to the nearest vector. `steps` of half an axis, [`FINE`] or fewer.
pub(super) fn octahedral(n: [f32; 3], steps: i8) -> [u8; 4] {
    let one = f64::from(steps);
    let [x, y, z] = n.map(f64::from);
    let sum = (x.abs() + y.abs() + z.abs()).max(f64::MIN_POSITIVE);
    let (mut u, mut v) = (x / sum, y / sum);
    if z < 0.0 {
        let sign = |a: f64| if a >= 0.0 { 1.0 } else { -1.0 };
        (u, v) = ((1.0 - v.abs()) * sign(u), (1.0 - u.abs()) * sign(v));
    }
    let (low_u, low_v) = ((u * one).floor(), (v * one).floor());
    let off = |[u, v]: [f64; 2]| {
        let most = f64::from(FINE);
        let [a, b, c] = on_sphere([u, v, one], most);
        (a - most * x) * (a - most * x) + (b - most * y) * (b - most * y) + (c - most * z) * (c - most * z)
    };
    let all = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let all = all.map(|[a, b]| [(low_u + a).clamp(-one, one), (low_v + b).clamp(-one, one)]);
    let best = all.into_iter().min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or_default();
    #[expect(clippy::cast_possible_truncation, reason = "-127 to 127")]
    let byte = |x: f64| (x as i8).to_le_bytes()[0];
    [byte(best[0]), byte(best[1]), steps.to_le_bytes()[0], 0]
}

/// Number of steps of a stored component of a quaternion, from 0 to the largest that one of the smaller three can be.
const TURN_STEPS: f64 = 127.0;

/// Returns a unit quaternion (x, y, z, w) as [`Filter::Quaternion`] stores it: among the eight rows of whole numbers
/// around it the one that decodes to the nearest rotation, to two thirds of a degree.
pub(super) fn quaternion(q: [f64; 4]) -> [u8; 8] {
    let largest = (0..4).fold(0, |best, k| if q[k].abs() > q[best].abs() { k } else { best });
    // A quaternion and its negative are the same rotation: the omitted component is positive.
    let sign = if q[largest] < 0.0 { -1.0 } else { 1.0 };
    let scale = TURN_STEPS * core::f64::consts::SQRT_2;
    let own = [1, 2, 3].map(|k| sign * q[(largest + k) % 4]);
    let around = |corner: usize| {
        let step = |k: usize| (own[k] * scale).floor() + f64::from(u8::from(corner >> k & 1 == 1));
        [0, 1, 2].map(|k| step(k).clamp(-TURN_STEPS, TURN_STEPS))
    };
    // The cosine of half the angle between the two.
    let nearness = |steps: [f64; 3]| {
        let lesser = steps.map(|x| x / scale);
        let rest = 1.0 - lesser.iter().map(|x| x * x).sum::<f64>();
        let w = rest.max(0.0).sqrt();
        w * q[largest].abs() + (0..3).map(|k| lesser[k] * own[k]).sum::<f64>()
    };
    let best = (0..8).map(around).max_by(|a, b| nearness(*a).total_cmp(&nearness(*b))).unwrap_or_default();
    #[expect(clippy::cast_possible_truncation, reason = "-127 to 127")]
    let [x, y, z] = best.map(|x| x as i16);
    #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "124 to 127")]
    let last = (TURN_STEPS as i16 & !3) | largest as i16;
    let mut stored = [0; 8];
    put(&mut stored, [x, y, z, last]);
    stored
}

/// Returns the exponent of the largest power of two that is at most `step`, which is above 0.
pub(super) fn power_within(step: f64) -> i32 {
    let exponent = i32::try_from(step.to_bits() >> 52 & 0x7ff).unwrap_or(0) - 1023;
    exponent.clamp(LEAST_POWER, MOST_POWER)
}

/// Smallest exponent of a step with which single precision can hold 24 bits of steps.
const LEAST_POWER: i32 = -100;
/// Largest such exponent.
const MOST_POWER: i32 = 100;
/// The largest signed whole number of 24 bits.
const MOST_WHOLE: f64 = 8_388_607.0;

/// Returns a number as [`Filter::Exponential`] stores it, in steps of 2 to the power of `power`: it decodes to within
/// half a step.
pub(super) fn exponential(x: f64, power: i32) -> [u8; 4] {
    let step = two_to(power);
    #[expect(clippy::cast_possible_truncation, reason = "24 bits")]
    let whole = (x / step).round().clamp(-MOST_WHOLE, MOST_WHOLE) as i32;
    (power << 24 | whole & 0x00ff_ffff).to_le_bytes()
}

#[cfg(test)]
mod tests {
    use meshoptimizer_rs::codec;

    use super::*;

    #[test]
    fn turns_come_back_to_two_thirds_of_a_degree() {
        let mut worst: f64 = 0.0;
        for i in 0..60_000 {
            let mut q =
                [0.618_034, 0.754_878, 0.569_840, 0.819_173].map(|k| (f64::from(i) * k).fract() - 0.5);
            // A third have components that are nearly equal: there the omitted one takes the errors of all.
            if i % 3 == 0 {
                q = q.map(|x| if x < 0.0 { -0.5 } else { 0.5 } + x / 10.0);
            }
            let q = glam::DQuat::from_array(q).normalize();
            let mut stored = quaternion(q.to_array());
            Filter::Quaternion.decode(&mut stored, 8).expect("eight bytes");
            let back = glam::DQuat::from_array(words(&stored).map(f64::from)).normalize();
            worst = worst.max(2.0 * base::ops::acos_clamped(back.dot(q).abs()).to_degrees());
        }
        assert!(worst < 2.0 / 3.0 && worst > 0.1, "{worst} degrees");
    }

    #[test]
    fn numbers_come_back_to_half_a_step() {
        assert_eq!([1.0, 0.9, 0.001, 2.5].map(power_within), [0, -1, -10, 1]);
        for (x, power) in [(12.345, -10), (-0.004, -10), (0.0, -3), (1e-5, -24), (-8191.0, -10), (3.5, 1)] {
            let mut stored = exponential(x, power);
            Filter::Exponential.decode(&mut stored, 4).expect("four bytes");
            let off = (f64::from(f32::from_le_bytes(stored)) - x).abs();
            assert!(off <= two_to(power) / 2.0, "{x}: {off}");
        }
    }

    #[test]
    fn unit_vectors_come_back_to_a_degree_or_to_four() {
        let [fine, coarse] = [FINE, COARSE].map(worst);
        assert!(fine < 1.0 && coarse < 4.0, "{fine}, {coarse} degrees");
    }

    /// Returns the largest angle in degrees between a vector and its decoded form.
    fn worst(steps: i8) -> f64 {
        let mut worst: f64 = 0.0;
        for i in 0..2000 {
            let (height, turn) = (1.0 - f64::from(i) / 999.5, f64::from(i) * 2.4);
            let wide = (1.0 - height * height).max(0.0).sqrt();
            let n = [wide * base::ops::cos(turn), wide * base::ops::sin(turn), height];
            #[expect(clippy::cast_possible_truncation, reason = "-1 to 1")]
            let mut stored = octahedral(n.map(|x| x as f32), steps);
            assert_eq!(stored[2..], [steps.to_le_bytes()[0], 0]);
            Filter::Octahedral.decode(&mut stored, 4).expect("four bytes");
            let back = glam::DVec3::from([0, 1, 2].map(|k| f64::from(i8::from_le_bytes([stored[k]]))));
            let cosine = back.normalize().dot(n.into());
            worst = worst.max(base::ops::acos_clamped(cosine).to_degrees());
        }
        worst
    }

    #[test]
    fn what_other_programs_store_is_what_the_extension_says() {
        // The axes; 16 bits.
        let mut stored = [0_u8; 8];
        put(&mut stored, [0, 0, 2047, 5]);
        Filter::Octahedral.decode(&mut stored, 8).expect("eight bytes");
        assert_eq!(words(&stored), [0, 0, 32_767, 5]);
        // No turn: three zeros, the largest is the fourth.
        put(&mut stored, [0, 0, 0, 2047]);
        Filter::Quaternion.decode(&mut stored, 8).expect("eight bytes");
        assert_eq!(words(&stored), [0, 0, 0, 32_767]);
        // A quarter turn about the first axis: the largest is the first, equal to the fourth.
        put(&mut stored, [0, 0, 2047, 2044]);
        Filter::Quaternion.decode(&mut stored, 8).expect("eight bytes");
        assert_eq!(words(&stored), [23_170, 0, 0, 23_170]);
        let mut float = (-3_i32 << 24 | 12).to_le_bytes();
        Filter::Exponential.decode(&mut float, 4).expect("four bytes");
        assert_eq!(f32::from_le_bytes(float), 1.5);
        // Never a panic.
        for e in [[0_u8; 4], [255; 4], [128; 4], [127, 129, 0, 1]] {
            Filter::Octahedral.decode(&mut e.clone(), 4).expect("four bytes");
            Filter::Exponential.decode(&mut e.clone(), 4).expect("four bytes");
        }
        assert_eq!(Filter::Quaternion.decode(&mut [0; 4], 4), None);
        assert_eq!(Filter::from_word("WRONG"), None);
    }

    #[test]
    fn an_independent_codec_undoes_the_filters_in_the_same_way() {
        let mut work = meshoptimizer_rs::Workspace::default();
        let turn = |i: f64| [base::ops::sin(i), base::ops::cos(i) * 0.6, base::ops::cos(i) * 0.8];
        let mut octahedrons = Vec::new();
        let (mut quaternions, mut floats) = (Vec::new(), Vec::new());
        for i in 0..600 {
            let [x, y, z] = turn(f64::from(i));
            #[expect(clippy::cast_possible_truncation, reason = "-1 to 1")]
            octahedrons
                .extend(octahedral([x, y, z].map(|v| v as f32), if i % 2 == 0 { FINE } else { COARSE }));
            quaternions.extend(quaternion(glam::DQuat::from_xyzw(x, z, y, 0.3).normalize().to_array()));
            floats.extend(exponential(x * 30.0, -10));
        }
        let (mut ours, mut theirs) = (octahedrons.clone(), octahedrons);
        Filter::Octahedral.decode(&mut ours, 4).expect("four bytes");
        codec::decode_filter_oct(&mut theirs, 600, 4, &mut work).expect("reads");
        let off = |a: &u8, b: &u8| (i16::from(a.cast_signed()) - i16::from(b.cast_signed())).abs();
        assert!(
            ours.iter().zip(&theirs).all(|(a, b)| off(a, b) <= 1),
            "to a step, which is rounded in single precision"
        );
        let (mut ours, mut theirs) = (quaternions.clone(), quaternions);
        Filter::Quaternion.decode(&mut ours, 8).expect("eight bytes");
        codec::decode_filter_quat(&mut theirs, 600, 8, &mut work).expect("reads");
        for (a, b) in ours.chunks(8).zip(theirs.chunks(8)) {
            assert!((0..4).all(|k| words(a)[k].abs_diff(words(b)[k]) <= 1), "{:?} {:?}", words(a), words(b));
        }
        let (mut ours, mut theirs) = (floats.clone(), floats);
        Filter::Exponential.decode(&mut ours, 4).expect("four bytes");
        codec::decode_filter_exp(&mut theirs, 600, 4, &mut work).expect("reads");
        assert_eq!(ours, theirs);
    }
}
