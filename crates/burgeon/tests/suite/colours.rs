//! Colours of scans on the plants made of them, compared with known ones and with points that were kept back.

use crate::missing;
use std::sync::Arc;

use base::{Draw, Stream, ops};
use burgeon::formats::{CloudFormat, ExportSpec, read_cloud};
use burgeon::geom::KdTree;
use burgeon::glam::DVec3;
use burgeon::leaf::ScanSpec;
use burgeon::mesh::{Model, PointCloud, Texture};
use burgeon::plant::Shape;
use burgeon::{
    MadePlant, Report, Run, ScannedDays, Seed, SeedlingOptions, Unit, linear_of_srgb, make_leaf_from_scan,
    srgb_of_linear,
};

type Colour = [f64; 3];

const GREEN: Colour = [60.0, 130.0, 40.0];
const BROWN: Colour = [130.0, 90.0, 40.0];

/// Returns the paint of a leaf of 60 x 36 mm: one half green with pale veins, the other brown.
fn painted(x: f64, y: f64) -> Colour {
    let vein = (0.5 - (y + x.abs()).rem_euclid(0.008) / 0.008).abs() > 0.42;
    let [r, g, b] = if x < 0.0 { GREEN } else { BROWN };
    if vein && x < 0.0 { [r + 60.0, g + 50.0, b + 50.0] } else { [r, g, b] }
}

fn blade_point(x: f64, y: f64) -> DVec3 {
    DVec3::new(x, 0.25 * x.abs() - 6.0 * (y - 0.01) * (y - 0.01), -y)
}

/// Returns how far inside the margin a place is, metres; negative outside.
fn inside(x: f64, y: f64) -> f64 {
    0.018 * ops::sin(ops::PI * (y / 0.06)).max(0.0) - x.abs()
}

/// Returns places spread over the blade.
fn spread(s: &mut Stream, count: usize) -> Vec<(f64, f64)> {
    let mut out = Vec::with_capacity(count);
    while out.len() < count {
        let (x, y) = (s.range(-0.018, 0.018), s.range(0.0, 0.06));
        if inside(x, y) > 0.0 {
            out.push((x, y));
        }
    }
    out
}

fn in_hole(x: f64, y: f64) -> bool {
    DVec3::new(x - 0.006, y - 0.03, 0.0).length() < 0.002
}

fn bytes(c: Colour) -> [u8; 3] {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before the cast")]
    c.map(|x| x.round().clamp(0.0, 255.0) as u8)
}

/// Makes a scan of the leaf: noise of 0.1 mm and of 12 of 255 in each colour, a hole, and points along the margin that
/// are half of a pale ground.
fn scan(count: usize, seed: u64) -> PointCloud {
    let mut s = Seed::new(seed).stream(Draw::Test);
    let mut cloud = PointCloud::default();
    for (x, y) in spread(&mut s, count).into_iter().filter(|p| !in_hole(p.0, p.1)) {
        let mixed = if inside(x, y) < 0.0005 { 0.5 } else { 0.0 };
        let seen = painted(x, y).map(|c| ops::lerp(c, 235.0, mixed) + 12.0 * s.normal());
        cloud.points.push(blade_point(x, y) + 0.0001 * DVec3::new(s.normal(), s.normal(), s.normal()));
        cloud.colors.push(bytes(seen));
    }
    for k in 0..count / 16 {
        let (t, a) = (s.range(0.0, 0.04), s.range(0.0, ops::TAU));
        cloud
            .points
            .push(DVec3::new(0.001 * ops::cos(a), 0.3 * t + 0.001 * ops::sin(a), t) + blade_point(0.0, 0.0));
        cloud.colors.push(if k % 9 == 0 { [235; 3] } else { [120, 50, 60] });
    }
    cloud
}

/// Textures of the leaves of a plant, to be sampled at places.
struct Painting {
    tree: KdTree,
    texels: Vec<[u8; 3]>,
}

impl Painting {
    fn from_made(made: &MadePlant) -> Self {
        let (mut places, mut texels) = (Vec::new(), Vec::new());
        for organ in &made.plant.organs {
            let Shape::Sheet(sheet) = &made.plant.shapes[organ.shape.index()] else { panic!("a sheet") };
            let name = match sheet.form.expect("a texture of its own") {
                0 => "leaf".to_owned(),
                k => format!("leaf-{}", k + 1),
            };
            let look = made.model.materials.iter().find(|m| m.name == name).expect("its material");
            let texture: &Arc<Texture> = look.texture.as_ref().expect("its texture");
            let n = sheet.across.len();
            for k in 0..sheet.points.len() - n {
                let (i, j) = (k / n, k % n);
                for part in 0..if j + 1 < n { 64 } else { 0 } {
                    let (s, t) = (f64::from(part % 8) / 8.0, f64::from(part / 8) / 8.0);
                    let near = sheet.points[k].lerp(sheet.points[k + 1], s);
                    let place = near.lerp(sheet.points[k + n].lerp(sheet.points[k + n + 1], s), t);
                    let u = ops::lerp(sheet.across[j], sheet.across[j + 1], s);
                    let v = 1.0 - ops::lerp(sheet.along[i], sheet.along[i + 1], t);
                    places.push(organ.frame.place(place, organ.scale));
                    texels.push(texel(texture, u, v));
                }
            }
        }
        Self { tree: KdTree::new(&places), texels }
    }

    fn color_at(&self, p: DVec3) -> [u8; 3] {
        self.texels[self.tree.nearest(p, f64::INFINITY).expect("a place")]
    }
}

fn texel(texture: &Texture, u: f64, v: f64) -> [u8; 3] {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the picture")]
    let along = |x: f64, n: u32| ((x * f64::from(n)) as u32).min(n - 1) as usize;
    let at = 4 * (along(v, texture.height) * texture.width as usize + along(u, texture.width));
    [0, 1, 2].map(|k| texture.pixels[at + k])
}

/// Returns the mean difference of the three colours, of 255.
fn apart(a: [u8; 3], b: [u8; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(b))).sum::<f64>() / 3.0
}

/// Returns the mean difference of the three channels in linear light, each 0 to 255.
fn apart_in_light(a: [u8; 3], b: [u8; 3]) -> f64 {
    let light = |b: u8| 85.0 * linear_of_srgb(f64::from(b) / 255.0);
    a.iter().zip(b).map(|(a, b)| (light(*a) - light(b)).abs()).sum()
}

/// Returns the mean square difference of the three channels in linear light, each 0 to 255, which the mean minimises.
fn square(a: [u8; 3], b: [u8; 3]) -> f64 {
    let light = |b: u8| 255.0 * linear_of_srgb(f64::from(b) / 255.0);
    a.iter().zip(b).map(|(a, b)| (light(*a) - light(b)) * (light(*a) - light(b))).sum::<f64>() / 3.0
}

/// Returns the mean of colours in linear light: the best constant prediction.
fn one_colour(colors: &[[u8; 3]]) -> [u8; 3] {
    let mean = |k: usize| {
        let light = colors.iter().map(|c| linear_of_srgb(f64::from(c[k]) / 255.0)).sum::<f64>();
        255.0 * srgb_of_linear(light / colors.len() as f64)
    };
    bytes([mean(0), mean(1), mean(2)])
}

fn mean(rows: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = rows.len() as f64;
    rows.sum::<f64>() / n
}

fn leaf(cloud: &PointCloud) -> MadePlant {
    make_leaf_from_scan("t", cloud, &ScanSpec::default(), &Run::plain()).expect("a leaf").0
}

#[test]
fn a_painted_leaf_is_found_with_its_colours() {
    for (count, limit) in [(20_000, 9.0), (10_000, 11.0), (5_000, 14.0)] {
        let cloud = scan(count, 7);
        let made = leaf(&cloud);
        assert_eq!((made.model.validate().next(), made.plant.validate().next()), (None, None));
        let painting = Painting::from_made(&made);
        let places = spread(&mut Seed::new(8).stream(Draw::Test), 4000);
        let truth: Vec<[u8; 3]> = places.iter().map(|&(x, y)| bytes(painted(x, y))).collect();
        let trivial = one_colour(&truth);
        let errors = |wanted: &dyn Fn(f64, f64) -> bool, plain: bool| {
            let rows = places.iter().zip(&truth).filter(|((x, y), _)| wanted(*x, *y));
            let rows: Vec<f64> = rows
                .map(|(&(x, y), t)| {
                    apart(if plain { trivial } else { painting.color_at(blade_point(x, y)) }, *t)
                })
                .collect();
            mean(rows.into_iter())
        };
        let (all, plain) = (errors(&|_, _| true, false), errors(&|_, _| true, true));
        let (hole, margin) = (errors(&in_hole, false), errors(&|x, y| inside(x, y) < 0.0005, false));
        println!(
            "{count} points: {all:.2} of 255, one colour {plain:.2}; in the hole {hole:.2}, at the margin {margin:.2}"
        );
        assert!(all < limit && all < 0.5 * plain, "{count}: {all} {plain}");
        // The hole is in the brown half; margins are not half white.
        assert!(hole < 8.0 && margin < 30.0, "{count}: {hole} {margin}");
        let stalk = &made.plant.axes[0].colors;
        let off = stalk.iter().map(|c| {
            let c = c.map(|x| 255.0 * srgb_of_linear(f64::from(x)));
            apart(bytes(c), [120, 50, 60])
        });
        assert!(mean(off) < 4.0, "{count}: the stalk has the colour of most of its points: {stalk:?}");
    }
}

#[test]
fn colours_do_not_depend_on_threads_and_none_change_nothing() {
    struct Backwards;
    impl base::Executor for Backwards {
        fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
            (0..n).rev().for_each(job);
        }
    }
    let cloud = scan(4000, 3);
    let run = Run { executor: &Backwards, ..Run::plain() };
    let back = make_leaf_from_scan("t", &cloud, &ScanSpec::default(), &run).expect("a leaf").0;
    let made = leaf(&cloud);
    assert_eq!((&made.model, &made.plant), (&back.model, &back.plant));
    // Black points alone give no colour, nor do colours whose number is not that of the points.
    let bare = leaf(&PointCloud { colors: vec![], ..cloud.clone() });
    let black = leaf(&PointCloud { colors: vec![[0; 3]; cloud.points.len()], ..cloud.clone() });
    let ragged = leaf(&PointCloud { colors: vec![[9; 3]; 5], ..cloud.clone() });
    assert!(bare.model == black.model && bare.model == ragged.model);
    assert!(bare.model.materials.iter().all(|m| m.texture.is_none()));
    assert_ne!(bare.item.digest, made.item.digest);
}

#[test]
fn points_of_real_scans_that_were_kept_back_are_predicted() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/scans/single_leaves");
    let Ok(files) = std::fs::read_dir(folder) else {
        return missing::skipped(folder);
    };
    let axes = ExportSpec { unit: Unit::Millimetre, ..ExportSpec::default() };
    let mut paths: Vec<_> = files.filter_map(Result::ok).map(|f| f.path()).collect();
    paths.sort();
    let mut coloured = 0;
    for path in paths.iter().filter(|p| p.extension().is_some_and(|e| e == "txt")) {
        let bytes = std::fs::read(path).expect("a file");
        let cloud = read_cloud(bytes.as_slice(), CloudFormat::Xyz, &axes, &mut Report::default());
        let cloud = cloud.expect("a cloud");
        coloured += usize::from(!cloud.colors.is_empty());
        if !cloud.colors.is_empty() {
            predicted(&path.file_name().unwrap_or_default().to_string_lossy(), &cloud);
        }
    }
    assert_eq!(coloured, 2, "the two scans of soybean have colours");
}

#[test]
fn points_of_our_own_scan_that_were_kept_back_are_predicted() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/scans/leaf.txt");
    let axes = ExportSpec { unit: Unit::Millimetre, ..ExportSpec::default() };
    let bytes = std::fs::read(path).expect("a file");
    let cloud = read_cloud(bytes.as_slice(), CloudFormat::Xyz, &axes, &mut Report::default());
    predicted("leaf.txt", &cloud.expect("a cloud"));
}

/// Keeps one point of ten back: the leaf of the others, and of a half and a quarter of them, has its colour there.
#[expect(clippy::print_stdout, reason = "figures for whoever looks for them")]
fn predicted(name: &str, cloud: &PointCloud) {
    for step in [1, 2, 4] {
        let rows = |back: bool| {
            let of = move |k: &usize| (k % 10 == 9) == back && (back || k.is_multiple_of(step));
            (0..cloud.points.len()).filter(of).collect::<Vec<usize>>()
        };
        // At the margin a part of the beam passes the leaf, and the rest returns darker than the leaf.
        let all = KdTree::new(&cloud.points);
        let well_inside = |k: &usize| {
            let (p, mut near) = (cloud.points[*k], Vec::new());
            all.within(p, 0.004, &mut near);
            let middle = near.iter().map(|&i| cloud.points[i] - p).sum::<DVec3>() / near.len() as f64;
            middle.length() < 0.001
        };
        let known = cloud.select(&rows(false));
        let kept_back = cloud.select(&rows(true).into_iter().filter(well_inside).collect::<Vec<_>>());
        let painting = Painting::from_made(&leaf(&known));
        let trivial = one_colour(&known.colors);
        let pairs = || kept_back.points.iter().zip(&kept_back.colors);
        let root = f64::sqrt;
        let error = root(mean(pairs().map(|(p, c)| square(painting.color_at(*p), *c))));
        let plain = root(mean(pairs().map(|(_, c)| square(trivial, *c))));
        // A single point is mostly noise, so the means of those within 4 mm are compared, too.
        let tree = KdTree::new(&kept_back.points);
        let around = |p: DVec3| {
            let mut near = Vec::new();
            tree.within(p, 0.004, &mut near);
            near
        };
        let truth: Vec<[u8; 3]> =
            kept_back.points.iter().map(|p| one_colour(&kept_back.select(&around(*p)).colors)).collect();
        let ours = |p: DVec3| {
            let texels: Vec<[u8; 3]> =
                around(p).into_iter().map(|k| painting.color_at(kept_back.points[k])).collect();
            one_colour(&texels)
        };
        let even = mean(kept_back.points.iter().zip(&truth).map(|(p, t)| apart_in_light(ours(*p), *t)));
        let plainly = mean(truth.iter().map(|t| apart_in_light(trivial, *t)));
        // The best prediction from neighbours.
        let known_tree = KdTree::new(&known.points);
        let sixteen = |p: DVec3| {
            let (mut gaps, mut near) = ([0.0; 16], Vec::new());
            known_tree.nearest_distances(p, &mut gaps);
            known_tree.within(p, gaps[15], &mut near);
            one_colour(&known.select(&near).colors)
        };
        let floor = root(mean(pairs().map(|(p, c)| square(sixteen(*p), *c))));
        println!(
            "{name} 1 of {step}: points {error:.2} of 255 of light, one colour {plain:.2}, 16 neighbours {floor:.2}; means {even:.2}, one colour {plainly:.2}"
        );
        assert!(error < plain && even < 0.95 * plainly, "{name}: {error} {plain}, {even} {plainly}");
    }
}

/// Makes a seedling: a brown stem and two leaves, the first of the colour given, the second green.
fn seedling(first: [u8; 3]) -> PointCloud {
    let mut s = Seed::new(5).stream(Draw::Test);
    let mut cloud = PointCloud::default();
    for _ in 0..1500 {
        let a = s.range(0.0, ops::TAU);
        cloud.points.push(DVec3::new(0.0012 * ops::cos(a), s.range(-0.03, 0.02), 0.0012 * ops::sin(a)));
        cloud.colors.push([110, 70, 60]);
    }
    for (turn, color) in [(0.3, first), (3.3, [50, 120, 40])] {
        let (sin, cos) = ops::sin_cos(turn);
        let mut left = 2500;
        while left > 0 {
            let (x, y) = (s.range(-0.03, 0.03), s.range(0.0, 0.09));
            let v = (y - 0.03) / 0.06;
            let half = if v < 0.0 { 0.001 } else { 0.02 * ops::sin(ops::PI * v).max(0.0).sqrt() };
            if x.abs() < half {
                left -= 1;
                cloud.points.push(DVec3::new(y * cos - x * sin, 0.02 + 0.3 * y, y * sin + x * cos));
                cloud.colors.push(color);
            }
        }
    }
    cloud
}

#[test]
fn a_seedling_between_two_days_has_the_mean_of_their_colours() {
    let (young, old) = ([60, 160, 60], [200, 190, 60]);
    let scans = [(0.0, seedling(young)), (4.0, seedling(old))];
    let days = ScannedDays::new(&scans, false, Seed::new(1), &Run::plain()).expect("organs");
    let options = SeedlingOptions::default();
    let half = one_colour(&[young, old]);
    for (day, want) in [(-1.0, young), (2.0, half), (4.0, old)] {
        let organs = days.organs(day, None, &Run::plain()).expect("a day");
        assert!(organs.iter().all(|o| o.colors.len() == o.points.len()), "one a point");
        let made = days.plant("t", (day, None), &options, &Run::plain()).expect("a plant");
        assert_eq!((made.model.validate().next(), made.plant.validate().next()), (None, None));
        assert_eq!(made.plant.organs.len(), 2);
        let painting = Painting::from_made(&made);
        let (sin, cos) = ops::sin_cos(0.3);
        let found = painting.color_at(DVec3::new(0.06 * cos, 0.038, 0.06 * sin));
        assert!(apart(found, want) < 3.0, "day {day}: {found:?}, not {want:?}");
        let (sin, cos) = ops::sin_cos(3.3);
        let other = painting.color_at(DVec3::new(0.06 * cos, 0.038, 0.06 * sin));
        assert!(apart(other, [50, 120, 40]) < 3.0, "day {day}: {other:?}");
        let stems = made.model.parts.iter().find(|p| p.name == "stems").expect("a stem");
        let reddest = stems.mesh.colors.iter().map(|c| c[0] - c[1]).fold(f32::MIN, f32::max);
        assert!(reddest > 0.05, "day {day}: the stem is brown");
        // Coarser copies keep their pictures.
        let coarse = made.at_level(1, &Run::plain()).expect("a copy");
        let painted = |m: &Model| m.materials.iter().filter(|m| m.texture.is_some()).count();
        assert_eq!((painted(&coarse), painted(&made.model)), (2, 2));
    }
}
