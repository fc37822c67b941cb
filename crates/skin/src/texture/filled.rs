//! Fills holes of a picture from around: means of ever larger squares, from the finest that has any (Gortler et al.
//! 1996).

/// Linear red, green and blue, 0 to 1.
pub(super) type Light = [f64; 3];
/// A texel, `None` if unknown.
pub(super) type Cell = Option<Light>;

/// Returns the cells of a picture with its unknown ones filled; empty for a picture without a known one.
///
/// Guaranteed: known cells stay. Cost: linear.
pub(super) fn filled(cells: Vec<Cell>, columns: usize) -> Vec<Cell> {
    let rows = cells.len() / columns.max(1);
    if columns * rows <= 1 || cells.iter().all(Option::is_some) {
        return cells;
    }
    let half = (columns.div_ceil(2), rows.div_ceil(2));
    let mean = |k: usize| {
        let (x, y) = (2 * (k % half.0), 2 * (k / half.0));
        let inside =
            |(x, y): (usize, usize)| (x < columns && y < rows).then(|| cells[y * columns + x]).flatten();
        let known: Vec<Light> =
            [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)].into_iter().filter_map(inside).collect();
        let n = known.len() as f64;
        (n > 0.0).then(|| [0, 1, 2].map(|c| known.iter().map(|l| l[c]).sum::<f64>() / n))
    };
    let coarse = filled((0..half.0 * half.1).map(mean).collect(), half.0);
    let between = |x: usize, y: usize| {
        // Three quarters of the square that contains the cell and a quarter of the next one, in both directions.
        let side = |at: usize, most: usize| {
            let next = if at.is_multiple_of(2) { (at / 2).saturating_sub(1) } else { at / 2 + 1 };
            [(at / 2, 0.75), (next.min(most - 1), 0.25)]
        };
        let mut sum = [0.0; 3];
        for (j, b) in side(y, half.1) {
            for (i, a) in side(x, half.0) {
                let light = coarse[j * half.0 + i]?;
                sum = [0, 1, 2].map(|c| sum[c] + a * b * light[c]);
            }
        }
        Some(sum)
    };
    let whole = cells.iter().enumerate().map(|(k, cell)| cell.or_else(|| between(k % columns, k / columns)));
    whole.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_filled_smoothly_and_what_is_known_stays() {
        let (columns, rows) = (37, 21);
        let known = |k: usize| {
            let x = k % columns;
            let hole = (8..30).contains(&x) && k / columns > 3;
            (!hole).then_some([x as f64, 1.0, 0.0])
        };
        let cells: Vec<Cell> = (0..columns * rows).map(known).collect();
        let whole = filled(cells.clone(), columns);
        assert!(cells.iter().zip(&whole).all(|(a, b)| a.is_none() || a == b));
        for row in whole.chunks(columns) {
            let row: Vec<f64> = row.iter().map(|c| c.expect("a filled cell")[0]).collect();
            let step = row.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
            assert!(step < 6.0, "{step}");
        }
        assert!(filled(vec![None; 12], 4).iter().all(Option::is_none));
        assert_eq!(filled(vec![Some([0.5; 3]), None, None], 3)[2], Some([0.5; 3]));
        assert_eq!(filled(Vec::new(), 0), []);
    }
}
