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

/// Slanting lines across a ring, from edge to edge.
fn hatches(centre: DVec2, radius: f64) -> Vec<Vec<InkSample>> {
    let slant = DVec2::new(0.8, 0.6);
    let across = |k: i32| {
        let x = radius * 0.2 * f64::from(k);
        let y = (radius * radius - x * x).sqrt();
        [DVec2::new(x, -y), DVec2::new(x, y)].map(|p| (centre + p.rotate(slant)).into()).to_vec()
    };
    (-3..=3).map(across).collect()
}

#[test]
fn neighbours_that_are_hatched_one_after_the_other_are_shaded_both() {
    let centres = [DVec2::ZERO, DVec2::new(20.5, 0.0)];
    let outlines = centres.map(|c| lined(vec![ring(c, 10.0, 40)]));
    let lines = centres.map(|c| hatches(c, 10.0)).concat();
    let normal = normalise(outlines.into_iter().chain([lined(lines)]).collect(), None);
    assert_eq!((normal.strokes.len(), counts(&normal)), (2, vec![(Change::Hatching, 14)]));
}

#[test]
fn an_outline_that_a_hand_drew_on_past_its_beginning_is_closed() {
    let mut outline = ring(DVec2::ZERO, 10.0, 40);
    let beyond: Vec<InkSample> = (1..6).map(|k| (outline[k].at * 1.03).into()).collect();
    outline.extend(beyond);
    assert!(is_closed(&outline));
    outline.reverse();
    assert!(is_closed(&outline));
    let open = &ring(DVec2::ZERO, 10.0, 40)[..30];
    assert!(!is_closed(open));
    let hook = line(&[[0.0, 0.0], [10.0, 0.0], [10.0, 0.5], [3.0, 0.5]]);
    assert!(!is_closed(&hook));
}

#[test]
fn an_area_that_is_painted_twice_is_one_and_a_thin_ring_is_not_solid() {
    let paint = |lines, even_odd| {
        let fill = Some(Fill { color: Some([200, 0, 0]), said: true, opacity: 1.0, even_odd });
        normalise(vec![Figure { lines, fill, ..Figure::default() }], None)
    };
    let twice = vec![ring(DVec2::ZERO, 10.0, 40), ring(DVec2::new(0.1, 0.0), 10.1, 40)];
    assert_eq!(counts(&paint(twice.clone(), false)), [(Change::DrawnTwice, 1)]);
    assert!(!counts(&paint(twice, true)).contains(&(Change::DrawnTwice, 1)));
    let mut inner = ring(DVec2::ZERO, 9.8, 40);
    inner.reverse();
    let thin = vec![ring(DVec2::ZERO, 10.0, 40), inner];
    assert!(!counts(&paint(thin, false)).contains(&(Change::DrawnTwice, 1)));
}

#[test]
fn the_rim_of_a_sticker_is_left_out_and_a_leaf_under_its_spots_stays() {
    let discs = |radius: f64| [-6.0, 6.0].map(|x| ring(DVec2::new(x, 0.0), radius, 40));
    let rim = |wide: f64| {
        let bone = |k: u32| {
            let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(k) / 60.0);
            (DVec2::new(6.0 * cos.signum(), 0.0) + DVec2::new(cos, sin) * (8.0 + wide)).into()
        };
        area(vec![(0..=60).map(bone).collect()], [255; 3])
    };
    let upon = |radius| discs(radius).map(|d| area(vec![d], [200, 0, 0])).to_vec();
    let sticker = normalise([vec![rim(1.0)], upon(8.0)].concat(), None);
    assert_eq!((sticker.strokes.len(), counts(&sticker)), (2, vec![(Change::Paper, 1)]));
    let leaf = normalise([vec![rim(1.0)], upon(2.0)].concat(), None);
    assert_eq!(leaf.strokes.len(), 3);
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
