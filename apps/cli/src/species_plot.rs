//! Distributions of traits, measured and grown, as a picture: a panel for each trait of each order.

use burgeon::growth::{Agreement, Trait, Traits};
use burgeon::render::Picture;

use crate::lettering::{ADVANCE, put_dot, write_text};

/// Width and height of a panel, pixels.
const PANEL: [i64; 2] = [230, 140];
/// Margins around its curves, pixels.
const ROOM: [i64; 4] = [14, 34, 14, 20];
/// Side of a dot of a letter, pixels.
const DOT: i64 = 2;
/// Colour of words and axes.
const DARK: [u8; 3] = [40, 40, 40];
/// Colour of frames.
const PALE: [u8; 3] = [200, 200, 200];
/// Colours of trees that were fitted, kept out, and grown, distinguishable for people who confuse red and green, too
/// (Okabe and Ito 2008).
const LOTS: [[u8; 3]; 3] = [[0, 114, 178], [230, 159, 0], [213, 94, 0]];
/// Names of the three lots of trees.
const LOT_NAMES: [&str; 3] = ["fitted", "kept out", "grown"];

struct Sheet(Picture);

impl Sheet {
    fn dot(&mut self, at: [i64; 2], colour: [u8; 3]) {
        put_dot(&mut self.0, at, colour);
    }

    fn text(&mut self, corner: [i64; 2], text: &str, colour: [u8; 3]) {
        write_text(&mut self.0, corner, text, (DOT, colour));
    }

    /// Draws the share of sorted values below each place of a panel, as a line.
    fn steps(&mut self, corner: [i64; 2], sorted: &[f64], [low, high]: [f64; 2], colour: [u8; 3]) {
        let (width, height) = (PANEL[0] - ROOM[0] - ROOM[2], PANEL[1] - ROOM[1] - ROOM[3]);
        let mut before = None;
        for x in 0..=width {
            let value = low + (high - low) * x as f64 / width as f64;
            let share = sorted.partition_point(|v| *v <= value) as f64 / sorted.len() as f64;
            #[expect(clippy::cast_possible_truncation, reason = "pixels of a panel")]
            let y = (height as f64 * (1.0 - share)).round() as i64;
            let from = before.unwrap_or(y);
            for y in from.min(y)..=from.max(y) {
                self.dot([corner[0] + ROOM[0] + x, corner[1] + ROOM[1] + y], colour);
                self.dot([corner[0] + ROOM[0] + x, corner[1] + ROOM[1] + y + 1], colour);
            }
            before = Some(y);
        }
    }
}

/// Formats a number in few letters.
fn short(value: f64) -> String {
    let digits = if value.abs() >= 100.0 {
        0
    } else if value.abs() >= 10.0 {
        1
    } else {
        3
    };
    format!("{value:.digits$}")
}

/// Share of values at either end that a panel leaves out: a single stray one would press all others into a line.
const BEYOND: f64 = 0.01;

/// Draws the distributions of all traits of trees that were fitted, kept out and grown, with p of grown against fitted.
pub(crate) fn picture_of(lots: [&Traits; 3], agreements: &[Agreement], orders: usize) -> Picture {
    let [width, height] = [PANEL[0] * orders.max(3) as i64, PANEL[1] * Trait::ALL.len() as i64 + ROOM[1]];
    let pixels = |n: i64| u32::try_from(n).unwrap_or(1);
    let mut sheet = Sheet(Picture::filled(pixels(width), pixels(height), [255; 4]));
    for (k, (name, colour)) in (0_i64..).zip(LOT_NAMES.into_iter().zip(LOTS)) {
        sheet.text([ROOM[0] + PANEL[0] * k / 2, 10], name, colour);
    }
    for (row, which) in (0_i64..).zip(Trait::ALL) {
        for (column, order) in (0_i64..).zip(0..orders).filter(|(_, o)| which.is_of(*o)) {
            let corner = [PANEL[0] * column, PANEL[1] * row + ROOM[1]];
            panel(&mut sheet, corner, lots, (which, order), agreements);
        }
    }
    sheet.0
}

fn panel(
    sheet: &mut Sheet,
    corner: [i64; 2],
    lots: [&Traits; 3],
    (which, order): (Trait, usize),
    agreements: &[Agreement],
) {
    let values = lots.map(|lot| {
        let mut own = lot.orders.get(order).map_or_else(Vec::new, |o| o.values(which).to_vec());
        own.sort_by(f64::total_cmp);
        own
    });
    if values.iter().all(Vec::is_empty) {
        return;
    }
    let mut all: Vec<f64> = values.iter().flatten().copied().collect();
    all.sort_by(f64::total_cmp);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a rank")]
    let cut = (BEYOND * all.len() as f64) as usize;
    let (low, high) = (all[cut], all[all.len() - 1 - cut]);
    let high = if high > low { high } else { low + 1e-6 };
    let [left, top] = [corner[0] + ROOM[0], corner[1] + ROOM[1]];
    let [right, bottom] = [corner[0] + PANEL[0] - ROOM[2], corner[1] + PANEL[1] - ROOM[3]];
    (left..=right).for_each(|x| sheet.dot([x, bottom], PALE));
    (top..=bottom).for_each(|y| sheet.dot([left, y], PALE));
    sheet.text([left, corner[1] + 6], &format!("{} {order} {}", which.word(), which.unit()), DARK);
    if let Some(a) = agreements.iter().find(|a| a.order == order && a.which == which) {
        sheet.text([left, corner[1] + 20], &format!("p {:.3}", a.p), DARK);
    }
    sheet.text([left, bottom + 5], &short(low), DARK);
    let end = short(high);
    sheet.text([right - DOT * ADVANCE * end.len() as i64, bottom + 5], &end, DARK);
    for (values, colour) in values.iter().zip(LOTS).filter(|(v, _)| !v.is_empty()) {
        sheet.steps(corner, values, [low, high], colour);
    }
}
