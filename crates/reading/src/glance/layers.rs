//! The layers of the network that looks at a picture.
//!
//! All numbers of a picture and of a layer's result lie cell by cell, the channels of a cell next to one another. Sums
//! are taken in one order, so the bits are the same everywhere.

use super::SIDE;

/// Channels of the picture, and after each convolution.
pub const CHANNELS: [usize; 4] = [1, 8, 16, 32];
/// Units between the last convolution and the words.
pub const HIDDEN: usize = 64;
/// Inputs of the units: the last convolution, pooled.
pub const GLIMPSE: usize = (SIDE / 8) * (SIDE / 8) * CHANNELS[3];
/// Cells of a kernel, along each side.
const KERNEL: usize = 3;

/// A layer of weights from every input of every cell of a kernel to every output.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layer {
    /// Cells of the kernel: 9 for a convolution, 1 for a fully connected layer.
    pub cells: usize,
    /// Input channels of each cell.
    pub inputs: usize,
    /// Output channels of each cell.
    pub outputs: usize,
    /// Weights by cell, input and output.
    pub weights: Vec<f32>,
    /// Bias of each output.
    pub bias: Vec<f32>,
}

impl Layer {
    /// Returns the weights from one input of one cell of the kernel.
    fn row(&self, cell: usize, input: usize) -> &[f32] {
        let at = (cell * self.inputs + input) * self.outputs;
        &self.weights[at..at + self.outputs]
    }

    /// Applies a fully connected layer; inputs of 0 cost nothing.
    pub fn join(&self, input: &[f32]) -> Vec<f32> {
        let mut out = self.bias.clone();
        for (i, &x) in input.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            out.iter_mut().zip(self.row(0, i)).for_each(|(o, w)| *o += x * w);
        }
        out
    }

    /// Applies a convolution of `side` by `side` cells, outside which everything is 0.
    pub fn convolve(&self, side: usize, input: &[f32]) -> Vec<f32> {
        let mut out: Vec<f32> = self.bias.iter().copied().cycle().take(side * side * self.outputs).collect();
        for (at, i, x) in cells(input, self.inputs) {
            for (cell, to) in reached(side, at) {
                let to = &mut out[to * self.outputs..(to + 1) * self.outputs];
                to.iter_mut().zip(self.row(cell, i)).for_each(|(o, w)| *o += x * w);
            }
        }
        out
    }

    /// Adds the gradient of the error by the weights to `own`, and returns the gradient by the inputs. `slope`: the
    /// gradient by the outputs.
    pub fn back(&self, side: usize, input: &[f32], slope: &[f32], own: &mut Self) -> Vec<f32> {
        let n = self.outputs;
        slope.chunks(n).for_each(|s| own.bias.iter_mut().zip(s).for_each(|(b, s)| *b += s));
        let mut back = vec![0.0; input.len()];
        for (at, i, x) in cells(input, self.inputs) {
            let reached = (self.cells > 1).then(|| reached(side, at)).into_iter().flatten();
            let mut sum = 0.0;
            for (cell, to) in reached.chain((self.cells == 1).then_some((0, 0))) {
                let slope = &slope[to * n..(to + 1) * n];
                let row = (cell * self.inputs + i) * n;
                own.weights[row..row + n].iter_mut().zip(slope).for_each(|(o, s)| *o += x * s);
                sum += self.row(cell, i).iter().zip(slope).map(|(w, s)| w * s).sum::<f32>();
            }
            back[at * self.inputs + i] = sum;
        }
        back
    }
}

/// Returns each number that is not 0, with its cell and its channel. A unit that is 0 passes nothing on, neither
/// forwards nor back.
fn cells(input: &[f32], channels: usize) -> impl Iterator<Item = (usize, usize, f32)> {
    let found = input.iter().enumerate().filter(|(_, x)| **x != 0.0);
    found.map(move |(k, x)| (k / channels, k % channels, *x))
}

/// Returns the cells to whose result a cell contributes, with the kernel's cell for each.
fn reached(side: usize, at: usize) -> impl Iterator<Item = (usize, usize)> {
    let (y, x) = (at / side, at % side);
    (0..KERNEL * KERNEL).filter_map(move |cell| {
        let (y, x) = (y + 1, x + 1);
        let (to_y, to_x) = (y.checked_sub(cell / KERNEL)?, x.checked_sub(cell % KERNEL)?);
        (to_y < side && to_x < side).then_some((cell, to_y * side + to_x))
    })
}

/// Returns the largest of two by two cells, and nothing below 0, and the place of each in the input. A single last row
/// or column is left out.
pub fn pooled(side: usize, channels: usize, input: &[f32]) -> (Vec<f32>, Vec<usize>) {
    let half = side / 2;
    let (mut out, mut from) = (Vec::with_capacity(half * half * channels), Vec::new());
    for cell in 0..half * half {
        let first = 2 * (cell / half) * side + 2 * (cell % half);
        for channel in 0..channels {
            let places = [0, 1, side, side + 1].map(|k| (first + k) * channels + channel);
            let best = places.into_iter().reduce(|a, b| if input[b] > input[a] { b } else { a });
            let best = best.unwrap_or_default();
            out.push(input[best].max(0.0));
            from.push(best);
        }
    }
    (out, from)
}

/// The whole network.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sight {
    /// Convolutions; each takes the pooled result of the one before.
    pub convolutions: [Layer; 3],
    /// From the last convolution to the units.
    pub hidden: Layer,
    /// From the units to the words.
    pub words: Layer,
}

/// Results of the network for a picture, layer by layer.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// Input of each convolution; the last is the input of the units.
    pub looked: [Vec<f32>; 4],
    /// Place of each number of `looked`, but the first, in the result of the convolution before it.
    pub from: [Vec<usize>; 3],
    /// Activation of each unit, 0 or more.
    pub units: Vec<f32>,
    /// How well each word describes the picture, before the softmax.
    pub words: Vec<f32>,
}

impl Sight {
    /// Returns a network whose coefficients are all 0.
    pub fn empty(words: usize) -> Self {
        let layer = |cells: usize, inputs: usize, outputs: usize| Layer {
            cells,
            inputs,
            outputs,
            weights: vec![0.0; cells * inputs * outputs],
            bias: vec![0.0; outputs],
        };
        let convolution = |k: usize| layer(KERNEL * KERNEL, CHANNELS[k], CHANNELS[k + 1]);
        Self {
            convolutions: [0, 1, 2].map(convolution),
            hidden: layer(1, GLIMPSE, HIDDEN),
            words: layer(1, HIDDEN, words),
        }
    }

    /// Returns the layers in the order in which they are applied.
    pub fn layers(&self) -> [&Layer; 5] {
        let [a, b, c] = &self.convolutions;
        [a, b, c, &self.hidden, &self.words]
    }

    /// Returns the layers of [`Sight::layers`], to be changed.
    pub fn layers_mut(&mut self) -> [&mut Layer; 5] {
        let [a, b, c] = &mut self.convolutions;
        [a, b, c, &mut self.hidden, &mut self.words]
    }

    /// Parses the network's file: for each layer a line with the bias and one for each cell and input.
    pub(super) fn parse(text: &str, words: usize) -> Option<Self> {
        let mut lines = text.lines().filter(|l| !l.starts_with('#'));
        let mut row = |to: &mut [f32]| {
            let mut cells = lines.next()?.split(',');
            to.iter_mut().try_for_each(|x| {
                *x = cells.next()?.parse().ok().filter(|x: &f32| x.is_finite())?;
                Some(())
            })?;
            cells.next().is_none().then_some(())
        };
        let mut sight = Self::empty(words);
        for layer in sight.layers_mut() {
            row(&mut layer.bias)?;
            layer.weights.chunks_mut(layer.outputs).try_for_each(&mut row)?;
        }
        lines.next().is_none().then_some(sight)
    }

    /// Looks at a picture. `looked` and `from` are kept for learning; a look costs about 0.3 million products.
    pub fn look(&self, picture: &[f32]) -> Seen {
        let mut seen = Seen::default();
        seen.looked[0] = picture.to_vec();
        for (k, layer) in self.convolutions.iter().enumerate() {
            let side = SIDE >> k;
            let (out, from) = pooled(side, layer.outputs, &layer.convolve(side, &seen.looked[k]));
            (seen.looked[k + 1], seen.from[k]) = (out, from);
        }
        seen.units = self.hidden.join(&seen.looked[3]).into_iter().map(|u| u.max(0.0)).collect();
        seen.words = self.words.join(&seen.units);
        seen
    }
}
