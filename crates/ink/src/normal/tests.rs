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
    let normal = normalise(figures.clone(), Some((DVec2::ZERO, DVec2::splat(70.0))), &[]);
    assert_eq!(counts(&normal), []);
    let same = normal.strokes.iter().zip(&figures).all(|(s, f)| s.samples == f.lines[0]);
    assert!(same && normal.strokes.len() == figures.len());
}

#[test]
fn solid_leaves_of_one_area_stay_outlines() {
    let leaves = (0..9).map(|k| ring(DVec2::new(30.0 * f64::from(k), 0.0), 10.0, 30)).collect();
    let normal = normalise(vec![area(leaves, [0, 90, 0])], None, &[]);
    assert_eq!((normal.strokes.len(), counts(&normal)), (9, vec![]));
}

/// Makes slanting lines across a ring, from edge to edge.
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
    let normal = normalise(outlines.into_iter().chain([lined(lines)]).collect(), None, &[]);
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
        normalise(vec![Figure { lines, fill, ..Figure::default() }], None, &[])
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
    let sticker = normalise([vec![rim(1.0)], upon(8.0)].concat(), None, &[]);
    assert_eq!((sticker.strokes.len(), counts(&sticker)), (2, vec![(Change::Paper, 1)]));
    let leaf = normalise([vec![rim(1.0)], upon(2.0)].concat(), None, &[]);
    assert_eq!(leaf.strokes.len(), 3);
}

#[test]
fn not_everything_is_paper() {
    let page = line(&[[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0], [0.0, 0.0]]);
    let normal = normalise(vec![lined(vec![page])], Some((DVec2::ZERO, DVec2::splat(9.0))), &[]);
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
        assert!(!normalise(figures.clone(), sheet, &[]).strokes.is_empty());
    }
}

#[test]
fn pieces_of_a_few_points_that_go_on_are_one_line_and_lines_that_only_meet_are_not() {
    let stem: Vec<InkSample> =
        (0..=90_u32).map(|k| DVec2::new(9.0 * ops::sin(0.05 * f64::from(k)), f64::from(k)).into()).collect();
    let pieces = (0..90).step_by(5).map(|k| lined(vec![stem[k..=k + 5].to_vec()])).collect();
    let normal = normalise(pieces, None, &[]);
    assert_eq!((normal.strokes.len(), counts(&normal)), (1, vec![(Change::Joined, 18)]));
    assert_eq!(normal.strokes[0].samples, stem);
    // A stem, and leaves that begin where it ends.
    let leaf = |x: f64| line(&[[0.0, 90.0], [x, 100.0], [2.0 * x, 99.0]]);
    let twig = vec![lined(vec![stem]), lined(vec![leaf(9.0)]), lined(vec![leaf(-9.0)])];
    assert_eq!(normalise(twig, None, &[]).strokes.len(), 3);
}

#[test]
fn lines_in_the_colour_of_the_page_are_not_seen_unless_they_lie_on_an_area() {
    let page = area(vec![line(&[[0.0, 0.0], [90.0, 0.0], [90.0, 90.0], [0.0, 90.0], [0.0, 0.0]])], [255; 3]);
    let drawn = |x: f64, color: [u8; 3]| {
        let mut figure = lined(vec![line(&[[x, 10.0], [x + 9.0, 40.0], [x, 80.0]])]);
        figure.like.color = Some(color);
        figure
    };
    let lines = vec![drawn(20.0, [0; 3]), drawn(40.0, [254; 3]), drawn(60.0, [0; 3])];
    let normal = normalise([vec![page.clone()], lines.clone()].concat(), None, &[]);
    assert_eq!((normal.strokes.len(), counts(&normal)), (2, vec![(Change::Paper, 2)]));
    let leaf = area(vec![ring(DVec2::splat(45.0), 30.0, 40)], [0, 120, 0]);
    let veins = normalise([vec![page, leaf], lines].concat(), None, &[]);
    assert_eq!(counts(&veins), [(Change::Paper, 1)]);
}

#[test]
fn lines_from_words_are_left_out_with_their_heads_and_a_stem_over_its_name_stays() {
    let stem = |x: f64| lined(vec![line(&[[x, 20.0], [x + 1.0, 50.0], [x, 80.0]])]);
    let leaf = |y: f64| lined(vec![line(&[[30.0, y], [40.0, y + 9.0], [50.0, y]])]);
    let plant = vec![stem(30.0), leaf(40.0), leaf(60.0)];
    let arrow = |y: f64| {
        let shaft = lined(vec![line(&[[88.0, y], [52.0, y]])]);
        vec![shaft, lined(vec![line(&[[54.0, y + 1.5], [52.0, y], [54.0, y - 1.5]])])]
    };
    let words = |x: f64, y: f64| (DVec2::new(x, y - 2.0), DVec2::new(x + 20.0, y + 2.0));
    let drawn = [plant.clone(), arrow(40.0), arrow(60.0)].concat();
    let normal = normalise(drawn.clone(), None, &[words(90.0, 40.0), words(90.0, 60.0)]);
    assert_eq!((normal.strokes.len(), counts(&normal)), (3, vec![(Change::Labels, 4)]));
    assert_eq!(counts(&normalise(drawn, None, &[])), []);
    let named = normalise(vec![stem(30.0), stem(60.0)], None, &[words(20.0, 15.0), words(50.0, 15.0)]);
    assert_eq!(counts(&named), []);
}

#[test]
fn frames_in_four_lines_and_crop_marks_are_paper_and_the_ground_is_not() {
    let rule = |a: [f64; 2], b: [f64; 2]| lined(vec![line(&[a, b])]);
    let plant = vec![
        lined(vec![line(&[[50.0, 10.0], [52.0, 40.0], [50.0, 80.0]])]),
        lined(vec![ring(DVec2::new(50.0, 80.0), 9.0, 30)]),
    ];
    let (low, high) = ([5.0, 5.0], [95.0, 95.0]);
    let frame =
        [rule(low, [95.0, 5.0]), rule([95.0, 5.0], high), rule(high, [5.0, 95.0]), rule([5.0, 95.0], low)];
    let normal = normalise([plant.clone(), frame.to_vec()].concat(), None, &[]);
    assert_eq!((normal.strokes.len(), counts(&normal)), (2, vec![(Change::Paper, 4)]));
    let ground = normalise([plant, vec![rule([5.0, 9.0], [95.0, 9.0])]].concat(), None, &[]);
    assert_eq!(counts(&ground), []);
}

#[test]
fn a_ring_around_a_plant_is_a_badge_and_the_rind_of_a_slice_is_not() {
    let rim = lined(vec![ring(DVec2::ZERO, 50.0, 60)]);
    let stem = lined(vec![line(&[[0.0, -42.0], [1.0, 0.0], [0.0, 40.0]])]);
    let plant = normalise(vec![rim.clone(), stem], None, &[]);
    assert_eq!(counts(&plant), [(Change::Paper, 1)]);
    let ray = |k: u32| {
        let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(k) / 9.0);
        lined(vec![vec![DVec2::ZERO.into(), (DVec2::new(cos, sin) * 44.0).into()]])
    };
    let slice = normalise((0..9).map(ray).chain([rim]).collect(), None, &[]);
    assert_eq!(counts(&slice), []);
}

#[test]
fn small_outlines_are_hatched_where_large_ones_are_and_a_midrib_is_no_hatch() {
    let (large, small) = (DVec2::ZERO, DVec2::new(40.0, 0.0));
    let outlines = [lined(vec![ring(large, 10.0, 40)]), lined(vec![ring(small, 4.0, 30)])];
    let few = hatches(small, 4.0)[2..5].to_vec();
    let alone = normalise(vec![outlines[1].clone(), lined(few.clone())], None, &[]);
    assert_eq!(alone.strokes.len(), 4);
    let rib = lined(vec![line(&[[-9.9, 0.0], [9.9, 0.5]])]);
    let drawn = [outlines.to_vec(), vec![lined(hatches(large, 10.0)), lined(few), rib]].concat();
    let normal = normalise(drawn, None, &[]);
    assert_eq!((normal.strokes.len(), counts(&normal)), (3, vec![(Change::Hatching, 10)]));
}

#[test]
fn pens_strokes_in_one_path_that_cross_are_one_line_each() {
    let stroke = |a: DVec2, b: DVec2| {
        let side = (b - a).perp().normalize_or_zero() * 0.5;
        let edge = |from: DVec2, to: DVec2| (0..=20).map(move |k| from.lerp(to, f64::from(k) / 20.0).into());
        let mut ring: Vec<InkSample> = edge(a + side, b + side).chain(edge(b - side, a - side)).collect();
        ring.push(ring[0]);
        ring
    };
    let lines = vec![
        stroke(DVec2::new(0.0, 0.0), DVec2::new(40.0, 40.0)),
        stroke(DVec2::new(0.0, 40.0), DVec2::new(40.0, 0.0)),
        stroke(DVec2::new(0.0, 20.0), DVec2::new(44.0, 21.0)),
    ];
    let mut figure = area(lines, [0; 3]);
    figure.fill.as_mut().expect("an area").even_odd = false;
    let normal = normalise(vec![figure], None, &[]);
    assert_eq!((normal.strokes.len(), counts(&normal)), (3, vec![(Change::PenOutline, 3)]));
}

#[test]
fn short_lines_in_segments_are_joined_where_long_ones_are() {
    let chopped = |from: u32, to: u32| -> Vec<Figure> {
        let at = |k: u32| [f64::from(k), 9.0 * ops::sin(0.3 * f64::from(k)) + f64::from(from)];
        (from..to).map(|k| lined(vec![line(&[at(k), at(k + 1)])])).collect()
    };
    let drawn = [chopped(0, 40), chopped(60, 63)].concat();
    assert_eq!(normalise(drawn, None, &[]).strokes.len(), 2);
    let short = [vec![lined(vec![ring(DVec2::splat(90.0), 40.0, 40)])], chopped(60, 63)].concat();
    assert_eq!(normalise(short, None, &[]).strokes.len(), 4);
}

#[test]
fn dots_of_one_size_in_small_outlines_are_stipple_and_a_few_are_not() {
    let centres = (0..8).map(|k| DVec2::new(30.0 * f64::from(k), 0.0));
    let outlines = centres.clone().map(|c| lined(vec![ring(c, 10.0, 40)]));
    let dots = |c: DVec2, n: u32| (0..n).map(move |k| area(vec![ring(c + f64::from(k), 0.3, 8)], [0; 3]));
    let drawn = |n: u32| outlines.clone().chain(centres.clone().flat_map(move |c| dots(c, n))).collect();
    let normal = normalise(drawn(4), None, &[]);
    assert_eq!((normal.strokes.len(), counts(&normal)), (8, vec![(Change::Hatching, 32)]));
    assert!(!counts(&normalise(drawn(1), None, &[])).iter().any(|(c, _)| *c == Change::Hatching));
}

/// Makes a flower as stickers are drawn: colours, and over them one dark area whose holes are the petals and the disc.
fn outlined_in_ink() -> Vec<Figure> {
    let at = |k: u32| base::turn::direction(ops::TAU * f64::from(k) / 5.0) * 24.0;
    let mut figures: Vec<Figure> =
        (0..5).map(|k| area(vec![ring(at(k), 12.5, 40)], [120, 130, 220])).collect();
    figures.push(area(vec![ring(DVec2::ZERO, 9.5, 40)], [230, 200, 20]));
    let mut dark = vec![ring(DVec2::ZERO, 39.0, 80)];
    dark.extend((0..5).map(|k| ring(at(k), 12.0, 40)));
    dark.push(ring(DVec2::ZERO, 9.0, 40));
    figures.push(area(dark, [40, 40, 110]));
    figures
}

#[test]
fn holes_of_painted_line_art_are_outlines_in_the_colours_behind_them() {
    let normal = normalise(outlined_in_ink(), None, &[]);
    let colors: Vec<_> = normal.strokes.iter().map(|s| s.color).collect();
    let petal = Some([120, 130, 220]);
    assert_eq!(colors, [petal, petal, petal, petal, petal, Some([230, 200, 20])]);
    assert_eq!(counts(&normal), [(Change::Colour, 6)]);
    // Without colours behind it, the same area is a plate with holes.
    let plate = outlined_in_ink().split_off(6);
    assert!(counts(&normalise(plate, None, &[])).iter().all(|(change, _)| *change != Change::Colour));
}

#[test]
fn a_small_white_gloss_is_no_organ_and_white_petals_are() {
    let fruit = area(vec![ring(DVec2::ZERO, 20.0, 60)], [200, 30, 40]);
    let gloss = area(vec![ring(DVec2::new(-6.0, 8.0), 3.0, 20)], [255, 255, 255]);
    let petal = area(vec![ring(DVec2::new(6.0, -2.0), 9.0, 30)], [255, 255, 255]);
    let normal = normalise(vec![fruit.clone(), gloss], None, &[]);
    assert_eq!((normal.strokes.len(), counts(&normal)), (1, vec![(Change::Shade, 1)]));
    assert_eq!(normalise(vec![fruit, petal], None, &[]).strokes.len(), 2);
}

#[test]
fn a_lighter_tone_of_a_leaf_is_shade_and_another_colour_is_an_organ() {
    let leaf = area(vec![ring(DVec2::ZERO, 20.0, 60)], [255, 170, 84]);
    let tone = area(vec![ring(DVec2::new(-6.0, 8.0), 3.0, 20)], [255, 204, 153]);
    let spot = area(vec![ring(DVec2::new(-6.0, 8.0), 3.0, 20)], [255, 244, 140]);
    assert_eq!(counts(&normalise(vec![leaf.clone(), tone], None, &[])), [(Change::Shade, 1)]);
    assert_eq!(normalise(vec![leaf, spot], None, &[]).strokes.len(), 2);
}

#[test]
fn a_rim_in_the_colour_of_an_area_is_part_of_it_and_a_petal_that_stands_out_is_not() {
    let leaf = area(vec![ring(DVec2::ZERO, 20.0, 60)], [30, 150, 80]);
    let rim = area(
        vec![ring(DVec2::new(10.0, 0.0), 9.0, 30), ring(DVec2::new(-12.0, 0.0), 9.0, 30)],
        [30, 150, 80],
    );
    let petal = area(vec![ring(DVec2::new(20.0, 0.0), 9.0, 30)], [30, 150, 80]);
    let normal = normalise(vec![leaf.clone(), rim.clone()], None, &[]);
    assert_eq!((normal.strokes.len(), counts(&normal)), (1, vec![(Change::DrawnTwice, 2)]));
    assert_eq!(normalise(vec![leaf.clone(), petal], None, &[]).strokes.len(), 2);
    let spots = Figure { fill: rim.fill.map(|f| Fill { color: Some([200, 30, 40]), ..f }), ..rim };
    assert_eq!(normalise(vec![leaf, spots], None, &[]).strokes.len(), 3);
}

#[test]
fn petals_are_no_dashes_of_the_pen_of_the_stem() {
    let bar = |x: f64, y: f64, width: f64, height: f64| {
        let corners = [[x, y], [x + width, y], [x + width, y + height], [x, y + height], [x, y]];
        line(&corners)
    };
    let stem = area(vec![bar(0.0, 0.0, 2.0, 80.0)], [40, 150, 40]);
    let petal = area(vec![bar(0.0, 82.0, 2.5, 8.0)], [220, 60, 120]);
    let dash = area(vec![bar(5.0, 0.0, 2.5, 8.0)], [40, 150, 40]);
    let normal = normalise(vec![stem, petal, dash], None, &[]);
    let points: Vec<bool> = normal.strokes.iter().map(|s| is_closed(&s.samples)).collect();
    assert_eq!(points, [false, true, false]);
}

#[test]
fn white_ink_is_not_seen_on_white_paper_and_is_on_an_area() {
    let net = |color| {
        // A ladder: its rungs make it no pen's stroke.
        let bar = |lo: [f64; 2], hi: [f64; 2]| line(&[lo, [hi[0], lo[1]], hi, [lo[0], hi[1]], lo]);
        area(
            vec![
                line(&[
                    [0.0, 0.0],
                    [1.0, 0.0],
                    [1.0, 20.0],
                    [20.0, 20.0],
                    [20.0, 21.0],
                    [1.0, 21.0],
                    [1.0, 60.0],
                    [0.0, 60.0],
                    [0.0, 0.0],
                ]),
                bar([30.0, 0.0], [31.0, 60.0]),
            ],
            color,
        )
    };
    let leaf = |at: f64, radius: f64| area(vec![ring(DVec2::new(at, 30.0), radius, 24)], [0, 160, 0]);
    let of = |figures: Vec<Figure>| normalise(figures, None, &[]).strokes.len();
    let white = [255; 3];
    assert_eq!(of(vec![net(white), leaf(100.0, 20.0)]), 1);
    // On a leaf it is seen, and in another colour too.
    assert!(of(vec![leaf(20.0, 60.0), net(white), leaf(200.0, 20.0)]) > 2);
    assert!(of(vec![net([90, 60, 30]), leaf(100.0, 20.0)]) > 1);
}

#[test]
fn an_organ_under_its_own_outline_seen_through_stays() {
    let at = DVec2::new(10.0, 10.0);
    let painted = |color: [u8; 3]| {
        let mut figure = area(vec![ring(at, 8.0, 24)], color);
        figure.like.color = Some(color);
        figure
    };
    let petal = painted([220, 30, 60]);
    let mut gloss = painted([250, 200, 210]);
    gloss.fill.as_mut().expect("an area").opacity = 0.5;
    let normal = normalise(vec![petal, gloss.clone(), gloss], None, &[]);
    assert_eq!(normal.strokes.len(), 1);
    assert_eq!(normal.strokes[0].color, Some([220, 30, 60]));
}
