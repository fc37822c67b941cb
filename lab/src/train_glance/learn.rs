//! Training of the network of [`reading::glance`]: the gradient of its error, batch by batch.

use base::{Draw, Seed, Stream, ops};
use reading::glance::{HIDDEN, Picture, SIDE, Sight};

use crate::adam::{self, ByWeight, Coefficient, Moments};

/// Number of steps.
const STEPS: usize = 3000;
/// Number of pictures in each step.
const BATCH: usize = 256;
/// Length of the first step.
const RATE: f64 = 2e-3;
/// Decay of coefficients towards 0.
const PULL: f64 = 1e-3;
/// Share of the inputs of the units, and of the units, that is dropped in each look.
const DROP: f64 = 0.2;
/// Standard deviation of the rotation of each look, radians.
const TURN: f64 = 0.1;
/// Standard deviation of the logarithm of the stretch of each look.
const STRETCH: f64 = 0.1;
/// Standard deviation of the slant of each look.
const SLANT: f64 = 0.1;
/// Largest shift of each look, cells.
const MOVED: f64 = 1.0;

/// A picture, its word, and its weight.
pub(super) struct Example {
    pub(super) picture: Picture,
    pub(super) word: usize,
    pub(super) weight: f64,
}

/// Trains the network that recognises the word of a picture.
pub(super) fn learn(examples: &[Example], words: usize) -> Sight {
    learn_in(examples, words, STEPS)
}

fn learn_in(examples: &[Example], words: usize, steps: usize) -> Sight {
    let seed = Seed::new(28);
    let mut sight = Sight::empty(words);
    let r = &mut seed.stream(Draw::Template);
    for layer in sight.layers_mut() {
        let spread = (2.0 / (layer.cells * layer.inputs) as f64).sqrt();
        layer.weights.iter_mut().for_each(|w| *w = f32::from_f64(r.normal() * spread));
    }
    let drawn = ByWeight::new(examples.iter().map(|e| e.weight));
    let mut moments = sight.layers().map(|l| [Moments::new(l.weights.len()), Moments::new(l.bias.len())]);
    for step in 0..steps {
        let part = |hand: u64| {
            let r = &mut seed.child(step as u64).child(hand).stream(Draw::Template);
            let mut slope = Sight::empty(words);
            for _ in 0..BATCH / HANDS {
                if let Some(at) = drawn.draw(r) {
                    look(&sight, &examples[at], r, &mut slope);
                }
            }
            slope
        };
        let mut slope = both(&part);
        let rate = adam::rate(RATE, step, steps);
        let own = sight.layers_mut().into_iter().zip(slope.layers_mut());
        for ((own, slope), [weights, bias]) in own.zip(&mut moments) {
            weights.step(&mut own.weights, &slope.weights, step + 1, rate, PULL);
            bias.step(&mut own.bias, &slope.bias, step + 1, rate, PULL);
        }
    }
    sight
}

/// Number of parts of a batch, each computed by a thread.
const HANDS: usize = 2;

/// Returns the sum of the gradients of both parts, in one order.
fn both(part: &(dyn Fn(u64) -> Sight + Sync)) -> Sight {
    let (mut sum, other) = std::thread::scope(|scope| {
        let other = scope.spawn(|| part(1));
        (part(0), other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    });
    for (a, b) in sum.layers_mut().into_iter().zip(other.layers()) {
        a.weights.iter_mut().zip(&b.weights).for_each(|(a, b)| *a += b);
        a.bias.iter_mut().zip(&b.bias).for_each(|(a, b)| *a += b);
    }
    sum
}

/// Adds the gradient of one look at an example.
fn look(sight: &Sight, example: &Example, r: &mut Stream, slope: &mut Sight) {
    let mut seen = sight.look(&varied(&example.picture, r));
    // Dropped inputs are 0, as if they had not been active.
    let keep = |r: &mut Stream| if r.chance(DROP) { 0.0 } else { f32::from_f64(1.0 / (1.0 - DROP)) };
    seen.looked[3].iter_mut().for_each(|x| *x *= keep(r));
    let mask: Vec<f32> = (0..HIDDEN).map(|_| keep(r)).collect();
    let units = sight.hidden.join(&seen.looked[3]);
    let units: Vec<f32> = units.iter().zip(&mask).map(|(u, m)| u.max(0.0) * m).collect();
    let sums = sight.words.join(&units);
    let most = sums.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let powers: Vec<f64> = sums.iter().map(|s| ops::exp(f64::from(s - most))).collect();
    let total: f64 = powers.iter().sum();
    let part = |p: f64| f32::from_f64(p / total / BATCH as f64);
    let mut miss: Vec<f32> = powers.iter().map(|p| part(*p)).collect();
    miss[example.word] -= f32::from_f64(1.0 / BATCH as f64);
    let mut back = sight.words.back(1, &units, &miss, &mut slope.words);
    back.iter_mut().zip(&mask).for_each(|(b, m)| *b *= m);
    let mut back = sight.hidden.back(1, &seen.looked[3], &back, &mut slope.hidden);
    // Dropped numbers are 0 and pass nothing; the others are scaled up accordingly.
    back.iter_mut().for_each(|b| *b *= f32::from_f64(1.0 / (1.0 - DROP)));
    for k in (0..sight.convolutions.len()).rev() {
        let (side, layer) = (SIDE >> k, &sight.convolutions[k]);
        let mut whole = vec![0.0; side * side * layer.outputs];
        for ((b, from), x) in back.iter().zip(&seen.from[k]).zip(&seen.looked[k + 1]) {
            if *x > 0.0 {
                whole[*from] += b;
            }
        }
        back = layer.back(side, &seen.looked[k], &whole, &mut slope.convolutions[k]);
    }
}

/// Returns a picture as another hand would have drawn it: turned, stretched, slanted, moved, or mirrored.
fn varied(picture: &[f32], r: &mut Stream) -> Picture {
    let (sin, cos) = ops::sin_cos(r.normal() * TURN);
    let (wide, tall) = (ops::exp(r.normal() * STRETCH), ops::exp(r.normal() * STRETCH));
    let slant = r.normal() * SLANT;
    let wide = if r.chance(0.5) { -wide } else { wide };
    let middle = (SIDE - 1) as f64 / 2.0;
    let off = [r.range(-MOVED, MOVED), r.range(-MOVED, MOVED)];
    let at = |y: isize, x: isize| -> f64 {
        let inside = |k: isize| usize::try_from(k).ok().filter(|k| *k < SIDE);
        inside(y).zip(inside(x)).map_or(0.0, |(y, x)| f64::from(picture[y * SIDE + x]))
    };
    let cell = |k: usize| {
        let (y, x) = ((k / SIDE) as f64 - middle, (k % SIDE) as f64 - middle);
        let (u, v) = ((x + slant * y) * wide, y * tall);
        let (u, v) = (cos * u - sin * v + middle + off[0], sin * u + cos * v + middle + off[1]);
        let (left, top) = (u.floor(), v.floor());
        let (right, down) = (u - left, v - top);
        #[expect(clippy::cast_possible_truncation, reason = "a few cells beyond the picture at most")]
        let (left, top) = (left as isize, top as isize);
        let row = |y: isize| at(y, left) * (1.0 - right) + at(y, left + 1) * right;
        f32::from_f64(row(top) * (1.0 - down) + row(top + 1) * down)
    };
    (0..SIDE * SIDE).map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use reading::glance::{Layer, pooled};

    #[test]
    fn the_slope_is_that_of_the_error() {
        let r = &mut Seed::new(4).stream(Draw::Template);
        let mut layer = Layer { cells: 9, inputs: 2, outputs: 3, weights: vec![0.0; 54], bias: vec![0.1; 3] };
        layer.weights.iter_mut().for_each(|w| *w = f32::from_f64(r.normal()));
        let input: Vec<f32> = (0..4 * 4 * 2).map(|_| f32::from_f64(r.uniform() + 0.1)).collect();
        let wanted: Vec<f32> = (0..4 * 4 * 3).map(|_| f32::from_f64(r.normal())).collect();
        let error = |layer: &Layer, input: &[f32]| -> f64 {
            let out = layer.convolve(4, input);
            out.iter().zip(&wanted).map(|(o, w)| f64::from(o - w) * f64::from(o - w) / 2.0).sum()
        };
        let slope: Vec<f32> = layer.convolve(4, &input).iter().zip(&wanted).map(|(o, w)| o - w).collect();
        let mut own = Layer { weights: vec![0.0; 54], bias: vec![0.0; 3], ..layer.clone() };
        let back = layer.back(4, &input, &slope, &mut own);
        for k in [0, 7, 30, 53] {
            let mut other = layer.clone();
            other.weights[k] += 1e-2;
            let step = (error(&other, &input) - error(&layer, &input)) / 1e-2;
            assert!(
                (step - f64::from(own.weights[k])).abs() < 0.1 * step.abs().max(1.0),
                "{step} {}",
                own.weights[k]
            );
        }
        for k in [0, 9, 31] {
            let mut other = input.clone();
            other[k] += 1e-2;
            let step = (error(&layer, &other) - error(&layer, &input)) / 1e-2;
            assert!((step - f64::from(back[k])).abs() < 0.1 * step.abs().max(1.0), "{step} {}", back[k]);
        }
    }

    #[test]
    fn what_tells_pictures_apart_is_learnt() {
        // A level line or an upright one.
        let line = |k: usize, upright: bool| -> Picture {
            (0..SIDE * SIDE)
                .map(|c| f32::from(u8::from(if upright { c % SIDE == k } else { c / SIDE == k })))
                .collect()
        };
        let example =
            |k: usize| Example { picture: line(4 + k, k.is_multiple_of(2)), word: k % 2, weight: 1.0 };
        let examples: Vec<Example> = (0..20).map(example).collect();
        let sight = learn_in(&examples, 2, 30);
        for e in &examples {
            let said = sight.look(&e.picture).words;
            assert!(said[e.word] > said[1 - e.word], "{said:?}");
        }
        let (half, _) =
            pooled(4, 1, &[-1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, -5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5]);
        assert_eq!(half, [3.0, 0.0, 0.0, 0.5]);
    }
}
