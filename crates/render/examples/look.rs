//! Renders a model of simple bodies to PNG files, to look at the renderer itself:
//! `cargo run -p burgeon-render --example look -- FOLDER`.

use std::sync::Arc;

use base::{Executor, Run, ops};
use glam::DVec3;
use mesh::{AlphaMode, Material, MaterialId, MaterialKind, Model, Part, Texture, TriMesh};
use render::{Background, PictureSpec, View, render};

struct Threads;

impl Executor for Threads {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        let next = std::sync::atomic::AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..2 {
                scope.spawn(|| {
                    loop {
                        let i = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                        if i >= n {
                            break;
                        }
                        job(i);
                    }
                });
            }
        });
    }
}

fn sphere(centre: DVec3, radius: f64) -> TriMesh {
    let (rings, sides) = (32_u32, 48_u32);
    let mut m = TriMesh::default();
    for i in 0..=rings {
        let (s, c) = ops::sin_cos(ops::PI * f64::from(i) / f64::from(rings));
        for j in 0..sides {
            let (sj, cj) = ops::sin_cos(ops::TAU * f64::from(j) / f64::from(sides));
            m.push(centre + DVec3::new(s * sj, c, s * cj) * radius);
        }
    }
    for i in 0..rings {
        for j in 0..sides {
            let k = (j + 1) % sides;
            let (a, b, c, d) = (i * sides + j, i * sides + k, (i + 1) * sides + k, (i + 1) * sides + j);
            m.triangles.extend([[a, d, c], [a, c, b]]);
        }
    }
    m.compute_normals();
    m
}

fn tube(from: DVec3, to: DVec3, r0: f64, r1: f64) -> TriMesh {
    let sides = 8_u32;
    let axis = (to - from).normalize_or(DVec3::Y);
    let u = axis.any_orthonormal_vector();
    let v = axis.cross(u);
    let mut m = TriMesh::default();
    for (p, r) in [(from, r0), (to, r1)] {
        for j in 0..sides {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(j) / f64::from(sides));
            m.push(p + (u * c + v * s) * r);
        }
    }
    for j in 0..sides {
        let k = (j + 1) % sides;
        m.triangles.extend([[j, k, sides + k], [j, sides + k, sides + j]]);
    }
    m.compute_normals();
    m
}

// A blade of 4 x 2 cells from `root` along `along`, bent downwards.
fn blade(root: DVec3, along: DVec3, length: f64) -> TriMesh {
    let across = along.cross(DVec3::Y).normalize_or(DVec3::X);
    let up = across.cross(along).normalize_or(DVec3::Y);
    let mut m = TriMesh::default();
    for i in 0..=6_u32 {
        let t = f64::from(i) / 6.0;
        for j in 0..=2_u32 {
            let s = f64::from(j) / 2.0 - 0.5;
            let lift = up * (0.3 * s.abs() - 0.35 * t * t) * length;
            m.push(root + along * (t * length) + across * (s * 0.6 * length) + lift);
            #[expect(clippy::cast_possible_truncation, reason = "0 to 1")]
            m.uvs.push([(s + 0.5) as f32, (1.0 - t) as f32]);
        }
    }
    for i in 0..6 {
        for j in 0..2 {
            let a = i * 3 + j;
            m.triangles.extend([[a, a + 1, a + 4], [a, a + 4, a + 3]]);
        }
    }
    m.compute_normals();
    m
}

fn leaf_texture() -> Texture {
    let n = 128_u32;
    let mut pixels = Vec::new();
    for y in 0..n {
        for x in 0..n {
            let s = (f64::from(x) + 0.5) / f64::from(n) - 0.5;
            let t = 1.0 - (f64::from(y) + 0.5) / f64::from(n);
            let half = 0.48 * ops::sin(ops::PI * ops::powf(t, 0.8));
            let vein = s.abs() < 0.02 || ((t - s.abs() * 0.8) * 9.0).fract() < 0.12;
            let green = if vein { [150, 190, 90] } else { [70, 130, 45] };
            pixels.extend([green[0], green[1], green[2], if s.abs() < half { 255 } else { 0 }]);
        }
    }
    Texture { width: n, height: n, pixels }
}

fn bodies() -> Model {
    let mut leaf = Material::plain("leaf", MaterialKind::Leaf, [1.0; 3]);
    leaf.texture = Some(Arc::new(leaf_texture()));
    leaf.alpha = AlphaMode::Mask;
    leaf.translucency = 0.4;
    leaf.roughness = 0.5;
    leaf.double_sided = true;
    let materials = vec![
        Material::plain("white", MaterialKind::Other, [0.8, 0.8, 0.78]),
        Material::plain("bark", MaterialKind::Bark, [0.22, 0.15, 0.1]),
        leaf,
        Material { roughness: 0.3, ..Material::plain("fruit", MaterialKind::Fruit, [0.6, 0.05, 0.04]) },
    ];
    let mut leaves = TriMesh::default();
    let mut wood = tube(DVec3::ZERO, DVec3::Y * 2.0, 0.08, 0.03);
    for k in 0..40_u32 {
        let t = f64::from(k) / 40.0;
        let (s, c) = ops::sin_cos(2.4 * f64::from(k));
        let out = DVec3::new(c, 0.5, s).normalize_or(DVec3::X);
        let root = DVec3::Y * (0.6 + 1.4 * t);
        let tip = root + out * (0.7 * (1.1 - t));
        wood.append(&tube(root, tip, 0.012, 0.003));
        for j in 0..4_u32 {
            let (s, c) = ops::sin_cos(2.4 * f64::from(k) + f64::from(j) - 1.5);
            leaves.append(&blade(
                root.lerp(tip, 0.4 + 0.2 * f64::from(j)),
                DVec3::new(c, 0.1, s).normalize_or(out),
                0.28,
            ));
        }
    }
    let part = |name: &str, material: usize, mesh| Part {
        name: name.into(),
        material: MaterialId::new(material),
        mesh,
    };
    let parts = vec![
        part("ball", 0, sphere(DVec3::new(1.1, 0.3, 0.3), 0.3)),
        part("fruit", 3, sphere(DVec3::new(-0.9, 0.2, 0.6), 0.2)),
        part("wood", 1, wood),
        part("leaves", 2, leaves),
    ];
    Model { name: "bodies".into(), parts, materials, offset_m: None }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::path::PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".into()));
    let model = bodies();
    let run = Run { executor: &Threads, ..Run::plain() };
    let shots = [
        ("three-quarter", View::ThreeQuarter, Background::Sky),
        ("front", View::Front, Background::Plain([255; 3])),
        ("top", View::Top, Background::Sky),
        ("transparent", View::ThreeQuarter, Background::Transparent),
        ("turntable", View::Turntable { frames: 8 }, Background::Sky),
    ];
    for (name, view, background) in shots {
        let start = std::time::Instant::now();
        let picture = render(&model, &PictureSpec { view, background, ..PictureSpec::default() }, &run)?;
        eprintln!("{name}: {} triangles in {:.2?}", model.triangle_count(), start.elapsed());
        let file = std::fs::File::create(folder.join(format!("{name}.png")))?;
        let mut png = png::Encoder::new(file, picture.width, picture.height);
        png.set_color(png::ColorType::Rgba);
        png.write_header()?.write_image_data(&picture.pixels)?;
    }
    Ok(())
}
