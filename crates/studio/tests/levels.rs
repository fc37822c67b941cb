//! Levels of detail of every species: fewer triangles by half and more, as much foliage, the same picture.

use burgeon::mesh::{MaterialKind, Model};
use burgeon::render::{Background, PictureSpec, View, render};
use burgeon::skin::SkinSpec;
use burgeon::{PRESETS, Run, Seed, TreeOptions, make_tree};

/// The area of what is of these kinds, one side, square metres.
fn area(model: &Model, is: impl Fn(MaterialKind) -> bool) -> f64 {
    let of = |p: &&mesh::Part| is(model.material(p).kind);
    let triangle = |m: &mesh::TriMesh, t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| m.position(i));
        0.5 * (b - a).cross(c - a).length()
    };
    model
        .parts
        .iter()
        .filter(of)
        .map(|p| p.mesh.triangles.iter().map(|t| triangle(&p.mesh, t)).sum::<f64>())
        .sum()
}

fn leaf(kind: MaterialKind) -> bool {
    kind == MaterialKind::Leaf
}

fn wood(kind: MaterialKind) -> bool {
    matches!(kind, MaterialKind::Bark | MaterialKind::YoungBark | MaterialKind::Stem)
}

/// The mean difference of two pictures of so many pixels a side, of a model and its copy, 0 to 1; and the share of pixels
/// that show the plant in the first and the second.
fn difference(a: &Model, b: &Model, pixels: u32) -> (f64, [f64; 2]) {
    let spec = PictureSpec {
        width: pixels,
        height: pixels,
        view: View::Front,
        background: Background::Transparent,
        ground_shadow: false,
        ..PictureSpec::default()
    };
    let draw = |m: &Model| render(m, &spec, &Run::plain()).expect("a picture").pixels;
    let (a, b) = (draw(a), draw(b));
    // Over grey, weighted by what covers the pixel.
    let over = |p: &[u8]| {
        [0, 1, 2].map(|k| {
            let alpha = f64::from(p[3]) / 255.0;
            (f64::from(p[k]) * alpha + 190.0 * (1.0 - alpha)) / 255.0
        })
    };
    let seen = |p: &[u8]| {
        p.chunks_exact(4).map(|p| f64::from(p[3]) / 255.0).sum::<f64>() / f64::from(pixels * pixels)
    };
    let pairs = a.chunks_exact(4).zip(b.chunks_exact(4));
    let differ = pairs.map(|(a, b)| {
        let (a, b) = (over(a), over(b));
        [0, 1, 2].iter().map(|&k| (a[k] - b[k]).abs()).sum::<f64>() / 3.0
    });
    (differ.sum::<f64>() / f64::from(pixels * pixels), [seen(&a), seen(&b)])
}

/// Two tests, because each is work for one core.
#[test]
fn each_level_halves_the_triangles_and_keeps_the_foliage() {
    holds_of(0);
}

#[test]
fn each_level_of_the_other_species_does_so_too() {
    holds_of(1);
}

/// Of every second species, from this one on.
#[expect(clippy::print_stdout, reason = "figures for the table of levels in docs/exports.md")]
fn holds_of(first: usize) {
    let options = TreeOptions {
        skin: SkinSpec { textures: false, ..SkinSpec::default() },
        lods: 3,
        ..TreeOptions::default()
    };
    let mut faults = Vec::new();
    for preset in PRESETS.iter().skip(first).step_by(2) {
        let spec = preset.spec().expect("sound");
        let made = make_tree(&spec, Seed::new(1), &options, &Run::plain()).expect("a tree");
        let levels: Vec<&Model> = std::iter::once(&made.model).chain(&made.lods).collect();
        let foliage = area(levels[0], leaf);
        for (level, pair) in levels.windows(2).enumerate() {
            let level = level + 1;
            let share = pair[1].triangle_count() as f64 / pair[0].triangle_count() as f64;
            let kept = if foliage > 0.0 { area(pair[1], leaf) / foliage } else { 1.0 };
            let timber = area(pair[1], wood) / area(levels[0], wood).max(1e-9);
            // A level is for half the size of the one before.
            let (differ, [fine, coarse]) = difference(levels[0], pair[1], 384 >> level);
            println!(
                "{}: level {level} has {} triangles, {share:.3} of the one before; leaves {kept:.3}, wood {timber:.3} of the whole; \
                 picture of {} pixels differs by {differ:.4}, covers {fine:.3} and {coarse:.3}",
                preset.key,
                pair[1].triangle_count(),
                384 >> level
            );
            // A mean of colours over the whole picture; the widest crowns differ by 0.07.
            if differ > 0.09 {
                faults.push(format!("{}: the picture of level {level} differs by {differ:.3}", preset.key));
            }
            if share > 0.5 {
                faults.push(format!(
                    "{}: level {level} has {share:.3} of the triangles of the one before",
                    preset.key
                ));
            }
            if (kept - 1.0).abs() > 0.05 {
                faults.push(format!("{}: level {level} has {kept:.3} of the foliage", preset.key));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
