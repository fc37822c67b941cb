//! The margin of a real network of veins, beside one that was found in another way: closed pixels.
#![expect(clippy::unwrap_used, reason = "tests")]
#![expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "cells of a picture")]

use crate::missing;
use std::path::Path;

use base::Report;
use geom::KdTree2;
use glam::DVec2;
use leaf::{Leaf, LeafSpec, VeinGraph};

/// Side of a cell, in pixels of the picture.
const CELL: f64 = 2.0;
/// Radius of the disc, in cells, that closes the meshes of the network.
const DISC: i32 = 9;

/// Returns the area in square pixels, and the edge, of the closed region around the drawn veins.
fn closed(graph: &VeinGraph) -> (f64, Vec<DVec2>) {
    let (lo, hi) =
        graph.nodes.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
    let pad = DVec2::splat(CELL * f64::from(3 * DISC));
    let size = ((hi - lo + 2.0 * pad) / CELL).ceil();
    let (wide, high) = (size.x as i32, size.y as i32);
    let row = |(x, y): (i32, i32)| usize::try_from(y * wide + x).unwrap();
    let mut veins = vec![false; row((0, high))];
    for &[a, b] in &graph.edges {
        let (a, b) = (graph.nodes[a as usize], graph.nodes[b as usize]);
        let parts = (a.distance(b) / (0.5 * CELL)).ceil().max(1.0);
        for k in 0..=parts as u32 {
            let at = (a.lerp(b, f64::from(k) / parts) - lo + pad) / CELL;
            veins[row((at.x as i32, at.y as i32))] = true;
        }
    }
    let all = || (0..high).flat_map(|y| (0..wide).map(move |x| (x, y)));
    let inside = |(x, y): (i32, i32)| x >= 0 && y >= 0 && x < wide && y < high;
    let beside = |(x, y): (i32, i32)| {
        [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)].into_iter().filter(|&c| inside(c))
    };
    // Adds everything within a disc of the set cells, from their edge.
    let grown = |on: &[bool]| {
        let mut out = on.to_vec();
        for (x, y) in all().filter(|&c| on[row(c)] && beside(c).any(|d| !on[row(d)])) {
            let near = (-DISC..=DISC).flat_map(|dy| (-DISC..=DISC).map(move |dx| (dx, dy)));
            for (dx, dy) in near.filter(|(dx, dy)| dx * dx + dy * dy <= DISC * DISC) {
                if inside((x + dx, y + dy)) {
                    out[row((x + dx, y + dy))] = true;
                }
            }
        }
        out
    };
    let empty: Vec<bool> = grown(&veins).iter().map(|on| !on).collect();
    let free = grown(&empty);
    // Cells that are not reached from the corner are leaf.
    let mut outside = vec![false; free.len()];
    let mut open = vec![(0, 0)];
    while let Some(c) = open.pop() {
        if free[row(c)] && !outside[row(c)] {
            outside[row(c)] = true;
            open.extend(beside(c));
        }
    }
    let area = outside.iter().filter(|o| !**o).count() as f64 * CELL * CELL;
    let edge = all().filter(|&c| !outside[row(c)] && beside(c).any(|d| outside[row(d)]));
    let place = |(x, y): (i32, i32)| lo - pad + DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) * CELL;
    (area, edge.map(place).collect())
}

/// A closed line every half pixel.
fn dense(line: &[DVec2]) -> Vec<DVec2> {
    let ends = line.iter().skip(1).chain(line.first());
    let parts = |(a, b): (&DVec2, &DVec2)| {
        let (a, b, n) = (*a, *b, (a.distance(*b) / 0.5).ceil().max(1.0));
        (0..n as u32).map(move |k| a.lerp(b, f64::from(k) / n)).collect::<Vec<_>>()
    };
    line.iter().zip(ends).flat_map(parts).collect()
}

/// Greatest and mean distance of places from the nearest of others.
fn apart(from: &[DVec2], to: &[DVec2]) -> (f64, f64) {
    let tree = KdTree2::new(to);
    let gaps: Vec<f64> =
        from.iter().map(|&p| to[tree.nearest(p, f64::INFINITY).unwrap()].distance(p)).collect();
    (gaps.iter().copied().fold(0.0, f64::max), gaps.iter().sum::<f64>() / gaps.len() as f64)
}

#[test]
fn a_measured_network_keeps_its_teeth_and_its_veins() {
    let file =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/leaves/zelkova_vein_graph.json");
    let Ok(bytes) = std::fs::read(&file) else {
        return missing::skipped(file.display());
    };
    let graph = formats::read_vein_graph(&bytes[..]).unwrap().graph;
    let margin = graph.margin().unwrap().expect("a margin");
    let marks = graph.marks(&mut Report::default()).unwrap();
    assert_eq!(marks.margin.len(), margin.len());
    let full = marks.complete(&mut Report::default()).unwrap();
    let blade = Leaf::new(&full, &LeafSpec::default()).unwrap().blade();
    // From the marks' places back to the picture's: the same points in both.
    let k = margin.len() / 2;
    let (a, b) = (marks.margin[0].truncate(), marks.margin[k].truncate());
    let turn = (margin[k] - margin[0]).rotate((b - a).normalize() * DVec2::new(1.0, -1.0)).normalize();
    let picture = |p: DVec2| margin[0] + turn.rotate(p - a);
    let own: Vec<DVec2> = blade.rim.iter().map(|r| picture(r.place.truncate())).collect();
    assert!(apart(&own, &margin).0 < 0.01, "the blade ends where the margin is");
    // Scaled to a leaf of 60 mm.
    let mm = 60.0 / marks.length();
    let (area, edge) = closed(&graph);
    let seven = {
        let bare = leaf::Marks { margin: Vec::new(), ..marks.clone() };
        Leaf::new(&bare.complete(&mut Report::default()).unwrap(), &LeafSpec::default()).unwrap().blade()
    };
    let grid = seven.surface.grid(&[0.0, 1.0], &(0..=400).map(|k| f64::from(k) / 400.0).collect::<Vec<_>>());
    let right = grid.iter().skip(1).step_by(2);
    let outline: Vec<DVec2> =
        right.chain(grid.iter().step_by(2).rev()).map(|p| picture(p.position.truncate())).collect();
    let mut found = Vec::new();
    for (name, line, own) in
        [("margin", &margin, blade.area_m2()), ("seven points a row", &outline, seven.area_m2())]
    {
        let line = dense(line);
        let (out, back) = (apart(&line, &edge), apart(&edge, &line));
        let inside = graph.nodes.iter().filter(|&&p| geom::contains(&line, p)).count() as f64
            / graph.nodes.len() as f64;
        println!(
            "{name}: area {:+.2} %, Hausdorff {:.2} mm, mean {:.3} / {:.3} mm, nodes within {:.2} %",
            100.0 * (own / area - 1.0),
            mm * out.0.max(back.0),
            mm * out.1,
            mm * back.1,
            100.0 * inside
        );
        found.push((own / area - 1.0, mm * out.1.max(back.1), inside));
    }
    let [own, seven] = found[..] else { panic!("two") };
    assert!(own.0.abs() < 0.02 && own.1 < 0.1, "{own:?}");
    // Veins that are not connected with the leaf's may lie outside.
    assert!(own.2 > 0.985, "{own:?}");
    assert!(own.1 < 0.5 * seven.1, "{own:?} {seven:?}");
}
