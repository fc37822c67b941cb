//! The flowers that come with the program.

use crate::wanted::FlowerSpec;

macro_rules! species {
    ($($name:literal),*) => {
        impl FlowerSpec {
            /// The names of the presets.
            pub const PRESETS: &'static [&'static str] = &[$($name),*];
        }

        const FILES: &[&str] = &[$(include_str!(concat!("../presets/", $name, ".toml"))),*];
    };
}

species![
    "rose",
    "lily",
    "tulip",
    "sunflower",
    "clivia",
    "peony",
    "magnolia",
    "cherry-blossom",
    "iris",
    "daisy",
    "poppy",
    "morning-glory",
    "orchid",
    "dandelion",
    "water-lily"
];

/// Returns a flower by name, one of [`FlowerSpec::PRESETS`].
///
/// ```
/// assert!(bloom::preset("lily").is_some() && bloom::preset("oak").is_none());
/// ```
pub fn preset(name: &str) -> Option<FlowerSpec> {
    let row = FlowerSpec::PRESETS.iter().position(|p| *p == name)?;
    let spec = spec::from_toml(FILES[row]);
    debug_assert!(spec.is_ok(), "{name}: {spec:?}");
    spec.ok()
}

/// Returns the file of a flower, as it comes with the program.
pub fn preset_text(name: &str) -> Option<&'static str> {
    let row = FlowerSpec::PRESETS.iter().position(|p| *p == name)?;
    FILES.get(row).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;
    use plant::OrganKind;

    #[test]
    fn petals_never_cross_from_bud_to_wilted() {
        for name in FlowerSpec::PRESETS {
            let spec = preset(name).unwrap();
            let law = spec.own_law();
            let mut worst = 0.0_f64;
            let first = spec.make_on_day(0.0, &law, Seed::new(1));
            for k in 0..=12 {
                let day = (spec.opening_days + spec.wilting_days) * f64::from(k) / 12.0;
                let flower = spec.make_on_day(day, &law, Seed::new(1));
                assert_eq!(flower.validate().count(), 0, "{name} at {day}");
                assert_eq!(flower.axes, first.axes, "{name}");
                let kept = |p: &plant::Plant| -> Vec<_> {
                    p.organs.iter().map(|o| (o.kind, o.bearer, o.flower, o.shape, o.key)).collect()
                };
                assert_eq!(kept(&flower), kept(&first), "{name}");
                let share = crate::part_overlap(&flower, None);
                println!("{name} day {day:.1}: {:.3} % of petal triangles cross", share * 100.0);
                worst = worst.max(share);
            }
            assert!(worst < 0.001, "{name}: {worst}");
        }
    }

    #[test]
    fn a_bud_is_slim_and_a_bloom_is_wide_and_stamens_grow() {
        for name in FlowerSpec::PRESETS {
            let spec = preset(name).unwrap();
            let law = spec.own_law();
            let width = |day: f64| {
                let flower = spec.make_on_day(day, &law, Seed::new(1));
                let corners: Vec<_> = flower.shapes.iter().map(|s| s.corners(1.0)).collect();
                let across = flower
                    .organs
                    .iter()
                    .filter(|o| o.kind == OrganKind::Petal) // leaves on the stem are as wide on each day
                    .flat_map(|o| corners[o.shape.index()].iter().map(|&c| o.frame.place(c, o.scale).x));
                let (low, high) = across.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
                high - low
            };
            let (bud, bloom) = (width(0.0), width(spec.opening_days));
            assert!(bloom > 1.15 * bud, "{name}: {bud} {bloom}");
        }
    }

    #[test]
    fn a_species_is_a_file_whose_faults_have_a_line() {
        for name in FlowerSpec::PRESETS {
            let own = preset(name).unwrap();
            assert_eq!(own.name, *name);
            assert_eq!(spec::from_json(&spec::to_json(&own)), Ok(own), "{name}");
        }
        for (text, want) in [
            (
                "name = \"a\"\n[[whorls]]\ncount = 5\npetals = 5\n",
                "line 4: whorls[0]: unknown field `petals`",
            ),
            (
                "nod_deg = 10\n[[whorls]]\n[[whorls]]\ncount = 0\n",
                "line 4: whorls[1].count must be 1 to 200, not 0",
            ),
            ("[[whorls]]\nbud_deg = [1, 2]\n", "line 2: whorls[0].bud_deg: "),
            (
                "stamens = { count = 6, length_m = 0.1, spread_deg = 200 }",
                "line 1: stamens.spread_deg must be 0 to 180 deg",
            ),
        ] {
            let fault = spec::from_toml::<FlowerSpec>(text).expect_err(text).to_string();
            assert!(fault.starts_with(want), "{text}: {fault}");
        }
    }
}
