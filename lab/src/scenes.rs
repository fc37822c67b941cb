//! The pictures of docs/trees.md and docs/shaping.md that do not show a species alone: part of `cargo xtask species`.

use std::fmt::Write as _;
use std::path::PathBuf;

use base::ops::{self, TAU};

use crate::pixels::tiled;
use crate::workshop::{Workshop, picture};
use xtask::shell::{Outcome, repository};

struct Scenes<'a>(&'a Workshop);

/// Makes them all.
pub(crate) fn make() -> Outcome {
    Workshop::with(|shop| {
        let scenes = Scenes(shop);
        scenes.compared()?;
        scenes.leaves()?;
        scenes.room()?;
        scenes.edits()
    })
}

impl Scenes<'_> {
    /// Runs `burgeon ARGS --png` and returns the path of the picture.
    fn drawn(&self, name: &str, size: &str, args: &[&str]) -> Result<PathBuf, String> {
        let png = self.0.folder.join(format!("{name}.png"));
        self.0.burgeon(&[args, &["--png", &png.display().to_string(), "--size", size]].concat())?;
        Ok(png)
    }

    fn compared(&self) -> Outcome {
        for (what, size, to) in
            [("oak", "430x430", "trees/oaks.png"), ("guided", "500x487", "trees/guided.png")]
        {
            tiled(&[vec![self.drawn(what, size, &["compare", what])?]], &picture(to))?;
        }
        Ok(())
    }

    fn leaves(&self) -> Outcome {
        let kept = |share| self.drawn(share, "360x360", &["grow", "oak", "--leaf-keep", share]);
        let row = ["1", "0.45", "0.15"].map(kept).into_iter().collect::<Result<Vec<_>, _>>()?;
        tiled(&[row], &picture("trees/leaf-keep.png"))?;
        let leaf = repository().join("fixtures/leaves/leaf1.csv").display().to_string();
        let own = self.drawn("own", "480x480", &["grow", "oak", "--leaf-template", &leaf])?;
        tiled(&[vec![own]], &picture("trees/own-leaf.png"))
    }

    /// Draws envelopes, obstacles, neighbours.
    fn room(&self) -> Outcome {
        self.0.file("ring.obj", &ring())?;
        let spec = self.0.file("ring.toml", &format!("{CLIPPED}{RING}"))?;
        tiled(&[vec![self.drawn("ring", "420x420", &["grow", &spec])?]], &picture("trees/ring.png"))?;
        let house = self.0.file("house.obj", HOUSE)?;
        let house = self.drawn("house", "600x480", &["grow", "oak", "--obstacle", &house])?;
        tiled(&[vec![house]], &picture("trees/house.png"))?;
        let mut grove = vec!["grow", "oak"];
        for root in ["0,0,0", "4.2,0,-1.2", "-3.6,0,-1.8", "1.2,0,-4.4", "-1.4,0,3.4"] {
            grove.extend(["--root", root]);
        }
        tiled(&[vec![self.drawn("grove", "640x448", &grove)?]], &picture("trees/grove.png"))?;
        self.0.file("topiary.xyz", &topiary())?;
        let spec = self.0.file("topiary.toml", &format!("{CLIPPED}{TOPIARY}"))?;
        tiled(&[vec![self.drawn("topiary", "300x460", &["grow", &spec])?]], &picture("trees/topiary.png"))
    }

    /// Draws an oak before and after each edit of docs/shaping.md.
    fn edits(&self) -> Outcome {
        let heart: Vec<String> = (0..40)
            .map(|k| {
                let t = TAU * f64::from(k) / 40.0;
                let (sin, cos) = (ops::sin(t), |n: f64| ops::cos(n * t));
                let across = 0.21 * 16.0 * sin * sin * sin;
                let up = 13.0 * cos(1.0) - 5.0 * cos(2.0) - 2.0 * cos(3.0) - cos(4.0);
                format!("[{across:.2}, {:.2}]", 5.6 + 0.21 * up)
            })
            .collect();
        let edits = [
            ("rotate", r#""axis": {"path": [0, 3]}, "turn": {"about": [0, 0, 1], "degrees": 50}"#.to_owned()),
            ("move", r#""axis": {"path": [0, 3]}, "to": {"slide-m": 5}"#.to_owned()),
            ("prune", r#""axis": {"path": [0, 3]}"#.to_owned()),
            ("regrow", r#""axis": {"path": [0, 3]}, "seed": 7"#.to_owned()),
            (
                "sketch-branch",
                r#""bearer": {"path": [0]}, "at": 0.3, "points": [[0, 2, 0], [2, 2.1, 0.3], [4.4, 2.5, 0.5], [6.4, 3.3, 0.4]], "twigs": 1"#
                    .to_owned(),
            ),
            ("silhouette", format!(r#""outline": [{}], "trim": true"#, heart.join(", "))),
        ];
        let before = self.drawn("before", "240x240", &["grow", "oak", "--view", "front"])?;
        for (op, what) in edits {
            let edit = self.0.file(
                "edit.json",
                &format!("{{\"schema\": \"burgeon.edits/1\", \"edits\": [{{\"op\": \"{op}\", {what}}}]}}"),
            )?;
            let args = ["shape", "oak", "--edits", &edit, "--view", "front"];
            let after = self.drawn("after", "240x240", &args)?;
            let name = op.strip_suffix("-branch").unwrap_or(op);
            tiled(&[vec![before.clone(), after]], &picture(&format!("shaping/oak-{name}.png")))?;
        }
        Ok(())
    }
}

/// Start of the spec of a tree that fills a clipped form.
const CLIPPED: &str = r##"[look]
bark = "smooth"
leaf_color = "#4c7840"
[method]
kind = "competition"
points = 6000
lifespan = 3
joints_share = 0.2
points_per_joint = 12
"##;

const RING: &str = r#"attraction_m = 0.8
kill_m = 0.2
envelope = { shape = "mesh", file = "ring.obj" }
[wood]
trunk_radius_m = 0.09
[leaves]
length_m = 0.12
spacing_m = 0.045
max_radius_m = 0.012
"#;

const TOPIARY: &str = r#"attraction_m = 0.4
kill_m = 0.1
envelope = { shape = "points", file = "topiary.xyz", reach_m = 0.06 }
[wood]
trunk_radius_m = 0.05
tip_radius_m = 0.002
[leaves]
length_m = 0.06
spacing_m = 0.025
max_radius_m = 0.006
"#;

/// A house with a saddle roof to the left of the tree, metres.
const HOUSE: &str = "v -5.2 0 -3\nv -1.4 0 -3\nv -1.4 0 3\nv -5.2 0 3\nv -5.2 3.2 -3\nv -1.4 3.2 -3\nv -1.4 3.2 3\n\
v -5.2 3.2 3\nv -3.3 5.2 -3\nv -3.3 5.2 3\nf 1 2 3 4\nf 1 5 9\nf 1 9 6\nf 1 6 2\nf 4 3 7\nf 4 7 10\nf 4 10 8\nf 2 6 7 3\n\
f 1 4 8 5\nf 6 9 10 7\nf 5 8 10 9\n";

/// Writes an upright torus that stands on the ground.
fn ring() -> String {
    let (around, across) = (48_u32, 16_u32);
    let mut obj = String::new();
    let angle = |k: u32, n: u32| TAU * f64::from(k) / f64::from(n);
    for i in 0..around {
        for j in 0..across {
            let (sin, cos) = ops::sin_cos(angle(i, around));
            let (out, back) = ops::sin_cos(angle(j, across));
            let r = 2.2 + 0.62 * back;
            let _ = writeln!(obj, "v {:.4} {:.4} {:.4}", r * sin, 3.3 - r * cos, 0.62 * out);
        }
    }
    let at = |i: u32, j: u32| 1 + (i % around) * across + j % across;
    for i in 0..around {
        for j in 0..across {
            let _ = writeln!(obj, "f {} {} {} {}", at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
        }
    }
    obj
}

/// Writes three balls on one another, as a scanner sees a clipped tree: points on a lattice within them.
fn topiary() -> String {
    let balls = [(1.35, 0.8), (2.55, 0.62), (3.45, 0.46)];
    let mut points = String::new();
    let step = |k: i32| 0.06 * f64::from(k);
    for (x, y, z) in (-14..=14).flat_map(|x| (0..=70).flat_map(move |y| (-14..=14).map(move |z| (x, y, z)))) {
        let p = (step(x), step(y), step(z));
        let inside = |&(height, radius): &(f64, f64)| {
            p.0 * p.0 + (p.1 - height) * (p.1 - height) + p.2 * p.2 <= radius * radius
        };
        if balls.iter().any(inside) {
            let _ = writeln!(points, "{:.3} {:.3} {:.3}", p.0, p.1, p.2);
        }
    }
    points
}
