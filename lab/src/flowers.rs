//! `cargo xtask flowers`: remakes the pictures of docs/bloom.md and of the venations in docs/leaves.md.

use std::path::PathBuf;

use crate::pixels::tiled;
use crate::workshop::{Workshop, picture};
use xtask::shell::{Outcome, repository, say};

/// Species, days from bud to full bloom, and from there to wilted.
const FLOWERS: [(&str, f64, f64); 15] = [
    ("rose", 6.0, 6.0),
    ("lily", 6.0, 5.0),
    ("tulip", 5.0, 5.0),
    ("sunflower", 8.0, 6.0),
    ("clivia", 9.0, 7.0),
    ("peony", 6.0, 6.0),
    ("magnolia", 7.0, 5.0),
    ("cherry-blossom", 5.0, 5.0),
    ("iris", 5.0, 4.0),
    ("daisy", 4.0, 6.0),
    ("poppy", 4.0, 4.0),
    ("morning-glory", 2.0, 3.0),
    ("orchid", 14.0, 14.0),
    ("dandelion", 3.0, 9.0),
    ("water-lily", 5.0, 5.0),
];

struct Maker<'a>(&'a Workshop);

pub(crate) fn run() -> Outcome {
    Workshop::with(|shop| {
        let maker = Maker(shop);
        maker.flowers().and_then(|()| maker.law()).and_then(|()| maker.venations())
    })?;
    say("docs/pictures/bloom-flowers.png, bloom-law.png and leaves/venation.png are made anew");
    Ok(())
}

impl Maker<'_> {
    /// Makes a picture of a flower at a day.
    fn flower(&self, name: &str, day: f64, more: &[&str]) -> Result<PathBuf, String> {
        let png = self.0.folder.join(format!("{name}-{day:.2}-{}.png", more.len()));
        let (day, model) = (day.to_string(), self.0.path("flower.glb"));
        let shown = png.display().to_string();
        let args = ["bloom", "run", name, "-o", &model, "--day", &day, "--png", &shown, "--size", "176x196"];
        self.0.burgeon(&[&args, more].concat())?;
        Ok(png)
    }

    fn flowers(&self) -> Outcome {
        let mut rows = Vec::new();
        for (name, opening, wilting) in FLOWERS {
            let late = [0.35, 0.7, 1.0].map(|t| opening + t * wilting);
            let days = [&[0.0, 0.3 * opening, 0.6 * opening, opening][..], &late].concat();
            rows.push(days.iter().map(|&d| self.flower(name, d, &[])).collect::<Result<Vec<_>, _>>()?);
        }
        tiled(&rows, &picture("bloom-flowers.png"))
    }

    /// Fits the law of an opening sunflower to nine shapes of it, which then sets the pace of a lily.
    fn law(&self) -> Outcome {
        let shapes = self.0.path("sunflower");
        self.0.burgeon(&["bloom", "run", "sunflower", "-o", &shapes, "--frames", "15", "--format", "obj"])?;
        let mut stages =
            String::from("unit = \"m\"\nname = \"sunflower\"\nsplit = \"none\"\nclean = false\n");
        for day in 0..9 {
            stages += &format!(
                "[[stage]]\nfile = \"sunflower/sunflower-{day:03}.obj\"\nday = {day}\norgan = \"petal\"\n"
            );
        }
        let (file, law) = (self.0.file("stages.toml", &stages)?, self.0.path("sunflower.law.json"));
        self.0.burgeon(&["bloom", "fit", &file, "-o", &law])?;
        let mut rows = Vec::new();
        for more in [vec![], vec!["--law", &law]] {
            let days = [0.0, 1.0, 1.7, 2.4, 3.2, 6.0];
            rows.push(days.iter().map(|&d| self.flower("lily", d, &more)).collect::<Result<Vec<_>, _>>()?);
        }
        tiled(&rows, &picture("bloom-law.png"))
    }

    fn venations(&self) -> Outcome {
        let marks = repository().join("fixtures/leaves/leaf2.csv").display().to_string();
        // The measured one hangs: from the front it would be seen along its midrib.
        let leaves: [(&[&str], &str); 4] = [
            (&[&marks, "--margin-vein"], "three-quarter"),
            (&["--venation", "palmate"], "front"),
            (&["--venation", "palmate", "--veins", "7", "--depth", "0.7"], "front"),
            (&["--venation", "parallel", "--length", "0.12"], "front"),
        ];
        let mut row = Vec::new();
        for (k, (leaf, view)) in leaves.iter().enumerate() {
            let png = self.0.folder.join(format!("leaf-{k}.png"));
            let shown = png.display().to_string();
            let args = ["leaf", "--png", &shown, "--size", "400x420", "--no-shadow", "--view", view];
            self.0.burgeon(&[&args[..1], leaf, &args[1..]].concat())?;
            row.push(png);
        }
        tiled(&[row], &picture("leaves/venation.png"))
    }
}
