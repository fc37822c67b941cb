use super::*;
use base::ops;

fn line(points: &[[f64; 2]]) -> Vec<InkSample> {
    points.iter().map(|&p| DVec2::from(p).into()).collect()
}

fn ring(centre: DVec2, radius: f64, n: u32) -> Vec<InkSample> {
    let at = |k: u32| {
        let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(k % n) / f64::from(n));
        (centre + DVec2::new(cos, sin) * radius).into()
    };
    (0..=n).map(at).collect()
}

fn lined(lines: Vec<Vec<InkSample>>) -> Figure {
    Figure { lines, lined: true, ..Figure::default() }
}

fn area(lines: Vec<Vec<InkSample>>, color: [u8; 3]) -> Figure {
    let fill = Some(Fill { color: Some(color), said: true, opacity: 1.0, even_odd: true });
    Figure { lines, lined: false, fill, ..Figure::default() }
}

fn counts(normal: &Normal) -> Vec<(Change, usize)> {
    normal.changes.iter().map(|(c, n)| (*c, *n)).collect()
}

#[test]
fn plain_strokes_pass_through() {
    let figures: Vec<Figure> = (0..40)
        .map(|k| {
            let x = f64::from(k);
            lined(vec![line(&[[x, 0.0], [x + 3.0, 20.0 + x], [x * 0.5, 44.0], [x, 60.0]])])
        })
        .collect();
    let normal = normalise(figures.clone(), Some((DVec2::ZERO, DVec2::splat(70.0))));
    assert_eq!(counts(&normal), []);
    let same = normal.strokes.iter().zip(&figures).all(|(s, f)| s.samples == f.lines[0]);
    assert!(same && normal.strokes.len() == figures.len());
}

#[test]
fn solid_leaves_of_one_area_stay_outlines() {
    let leaves = (0..9).map(|k| ring(DVec2::new(30.0 * f64::from(k), 0.0), 10.0, 30)).collect();
    let normal = normalise(vec![area(leaves, [0, 90, 0])], None);
    assert_eq!((normal.strokes.len(), counts(&normal)), (9, vec![]));
}

#[test]
fn not_everything_is_paper() {
    let page = line(&[[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0], [0.0, 0.0]]);
    let normal = normalise(vec![lined(vec![page])], Some((DVec2::ZERO, DVec2::splat(9.0))));
    assert_eq!((normal.strokes.len(), counts(&normal)), (1, vec![]));
}

#[test]
fn wrong_numbers_do_no_harm() {
    let bad = [f64::NAN, f64::INFINITY, 1e300, -1e300, 0.0];
    let mut figures = Vec::new();
    for x in bad {
        for y in bad {
            let l = line(&[[x, y], [y, x], [1.0, x], [y, 2.0], [x, y]]);
            figures.push(lined(vec![l.clone(), l.clone(), Vec::new()]));
            figures.push(area(vec![l.clone(), Vec::new(), l], [0, 0, 0]));
        }
    }
    for sheet in [None, Some((DVec2::ZERO, DVec2::NAN)), Some((DVec2::splat(-1e300), DVec2::splat(1e300)))] {
        assert!(!normalise(figures.clone(), sheet).strokes.is_empty());
    }
}
