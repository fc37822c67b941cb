//! Levels of detail of every species: at most half of the triangles, as much foliage, the same picture.

use burgeon::glam::DVec3;
use burgeon::mesh::{AlphaMode, MaterialKind, Model, Texture};
use burgeon::render::{Background, Camera, PictureSpec, View, shot};
use burgeon::skin::{FoliageStyle, SkinSpec};
use burgeon::{LevelSpec, PRESETS, Preset, Run, Seed, TreeOptions, make_tree};

use crate::SPECIES;
use crate::share::sample;

/// Returns the area of the parts of these kinds, one side, without holes of textures, square metres.
fn area(model: &Model, is: impl Fn(MaterialKind) -> bool) -> f64 {
    let of_part = |p: &mesh::Part| {
        let look = model.material(p);
        let holes = look.texture.as_ref().filter(|_| look.alpha == AlphaMode::Mask);
        p.mesh.triangles.iter().map(|t| triangle(&p.mesh, *t, holes.map(|t| &**t))).sum::<f64>()
    };
    model.parts.iter().filter(|p| is(model.material(p).kind)).map(of_part).sum()
}

/// Returns the area of a triangle, without the holes of its texture.
fn triangle(m: &mesh::TriMesh, t: [u32; 3], holes: Option<&Texture>) -> f64 {
    let [a, b, c] = t.map(|i| m.position(i));
    let whole = 0.5 * (b - a).cross(c - a).length();
    let Some(holes) = holes else { return whole };
    const STEPS: u32 = 12;
    let corners = t.map(|i| m.uvs[i as usize].map(f64::from));
    let seen = |i: u32, j: u32| {
        let step = |k: u32| (f64::from(k) + 1.0 / 3.0) / f64::from(STEPS);
        let w = [step(i), step(j), 1.0 - step(i) - step(j)];
        let at = |k: usize, n: u32| {
            let x = (0..3).map(|c| w[c] * corners[c][k]).sum::<f64>();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a row of the picture"
            )]
            let row = (x * f64::from(n)).clamp(0.0, f64::from(n - 1)) as usize;
            row
        };
        holes.pixels[4 * (at(1, holes.height) * holes.width as usize + at(0, holes.width)) + 3] >= 128
    };
    let samples: Vec<bool> =
        (0..STEPS).flat_map(|i| (0..STEPS - i).map(move |j| (i, j))).map(|(i, j)| seen(i, j)).collect();
    whole * samples.iter().filter(|s| **s).count() as f64 / samples.len() as f64
}

fn leaf(kind: MaterialKind) -> bool {
    kind == MaterialKind::Leaf
}

fn wood(kind: MaterialKind) -> bool {
    matches!(kind, MaterialKind::Bark | MaterialKind::YoungBark | MaterialKind::Stem)
}

/// A picture of a model in a square, over grey.
struct Shot {
    pixels: u32,
    /// Colours over grey, and the coverage of the pixel; each 0 to 1.
    seen: Vec<[f64; 4]>,
}

impl Shot {
    /// Takes it with a camera that frames the model `whole`, even if a coarser one extends beyond it.
    fn take(model: &Model, whole: &Model, pixels: u32) -> Self {
        let spec = PictureSpec {
            width: pixels,
            height: pixels,
            view: View::Front,
            background: Background::Transparent,
            ground_shadow: false,
            supersample: 2,
            ..PictureSpec::default()
        };
        let points =
            whole.parts.iter().flat_map(|p| &p.mesh.positions).map(|p| DVec3::from(p.map(f64::from)));
        let camera = Camera::framing(&points.collect::<Vec<_>>(), &spec);
        let picture = shot(model, &spec, camera, &Run::plain()).expect("a picture").pixels;
        let over = |p: &[u8]| {
            let alpha = f64::from(p[3]) / 255.0;
            let of = |k: usize| (f64::from(p[k]) * alpha + 190.0 * (1.0 - alpha)) / 255.0;
            [of(0), of(1), of(2), alpha]
        };
        Self { pixels, seen: picture.chunks_exact(4).map(over).collect() }
    }

    /// Returns the same at half the size.
    fn halved(&self) -> Self {
        let n = self.pixels / 2;
        let at = |x: u32, y: u32| self.seen[(y * self.pixels + x) as usize];
        let mean = |x: u32, y: u32| {
            let four =
                [at(2 * x, 2 * y), at(2 * x + 1, 2 * y), at(2 * x, 2 * y + 1), at(2 * x + 1, 2 * y + 1)];
            [0, 1, 2, 3].map(|k| four.iter().map(|p| p[k]).sum::<f64>() / 4.0)
        };
        Self {
            pixels: n,
            seen: (0..n).flat_map(|y| (0..n).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect(),
        }
    }

    /// Returns the mean difference of all pixels, 0 to 1.
    fn differs(&self, other: &Self) -> f64 {
        let of = |(a, b): (&[f64; 4], &[f64; 4])| (0..3).map(|k| (a[k] - b[k]).abs()).sum::<f64>() / 3.0;
        self.seen.iter().zip(&other.seen).map(of).sum::<f64>() / self.seen.len() as f64
    }

    /// Returns the share of the picture that shows the plant.
    fn covers(&self) -> f64 {
        self.seen.iter().map(|p| p[3]).sum::<f64>() / self.seen.len() as f64
    }
}

/// Two tests, because each takes one core.
#[test]
fn each_level_halves_the_triangles_and_keeps_the_foliage() {
    holds_of(0);
}

#[test]
fn each_level_of_the_other_species_does_so_too() {
    holds_of(1);
}

/// Tests every second species, from this one on, or a share of them.
fn holds_of(first: usize) {
    let options = TreeOptions {
        skin: SkinSpec { textures: false, ..SkinSpec::default() },
        levels: LevelSpec { lods: 3, ..LevelSpec::default() },
        ..TreeOptions::default()
    };
    let own: Vec<&str> = PRESETS.iter().map(|p| p.key).skip(first).step_by(2).collect();
    let keys = sample(&own, 0, SPECIES);
    let faults: Vec<String> = keys.into_iter().flat_map(|key| faults(key, &options)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Tests leaves in cards and in cards of shoots, and views from all sides: broad leaves, needles and leaflets.
#[test]
fn cards_and_shoots_keep_the_foliage_too() {
    let options = TreeOptions {
        skin: SkinSpec { texture_size: 128, foliage: FoliageStyle::ByLevel, ..SkinSpec::default() },
        levels: LevelSpec { lods: 3, impostor: Some(256), ..LevelSpec::default() },
        ..TreeOptions::default()
    };
    let faults: Vec<String> =
        ["oak", "spruce", "palm"].into_iter().flat_map(|key| faults(key, &options)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Triangles of a level that is light whatever the number of the one before.
const LIGHT: usize = 4_000;
/// Largest share of the triangles of a level, a half rounded to percents: the choice of leaves and flowers follows from
/// their places.
const HALF: f64 = 0.505;

/// Returns the faults of the levels of a species.
#[expect(clippy::print_stdout, reason = "figures for the table of levels in docs/exports.md")]
fn faults(key: &str, options: &TreeOptions) -> Vec<String> {
    let mut faults = Vec::new();
    let spec = Preset::find(key).expect("there").spec().expect("sound");
    let made = make_tree(&spec, Seed::new(1), options, &Run::plain()).expect("a tree");
    let levels: Vec<&Model> = std::iter::once(&made.model).chain(&made.levels.lods).collect();
    let foliage = area(levels[0], leaf);
    let mut fine = Shot::take(levels[0], levels[0], 192);
    for (level, pair) in levels.windows(2).enumerate() {
        let level = level + 1;
        if level > 1 {
            fine = fine.halved();
        }
        let views = pair[1].materials.iter().any(|m| m.impostor.is_some());
        let share = pair[1].triangle_count() as f64 / pair[0].triangle_count() as f64;
        let kept = if foliage > 0.0 && !views { area(pair[1], leaf) / foliage } else { 1.0 };
        let timber = area(pair[1], wood) / area(levels[0], wood).max(1e-9);
        // A level is for half the size of the one before.
        let coarse = Shot::take(pair[1], levels[0], fine.pixels);
        let differ = fine.differs(&coarse);
        let [whole, left] = [fine.covers(), coarse.covers()];
        println!(
            "{key}: level {level} has {} triangles, {share:.3} of the one before; leaves {kept:.3}, wood {timber:.3} of the whole; \
             picture of {} pixels differs by {differ:.4}, covers {whole:.3} and {left:.3}",
            pair[1].triangle_count(),
            fine.pixels,
        );
        // The mean of colours over the whole picture; the widest crowns differ by 0.07.
        if differ > 0.09 {
            faults.push(format!("{key}: the picture of level {level} differs by {differ:.3}"));
        }
        // A level with hardly any triangles left is as light as possible.
        if share > if pair[1].triangle_count() > LIGHT { HALF } else { 0.55 } {
            faults.push(format!("{key}: level {level} has {share:.3} of the triangles of the one before"));
        }
        if (kept - 1.0).abs() > 0.05 {
            faults.push(format!("{key}: level {level} has {kept:.3} of the foliage"));
        }
    }
    faults
}
