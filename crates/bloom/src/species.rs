//! Five flowers as data.

use crate::flower::{FlowerSpec, Whorl};

pub(crate) const PLAIN: Whorl = Whorl {
    count: 6,
    length: 0.05,
    width: 0.02,
    widest: 0.5,
    claw: 0.3,
    point: 0.5,
    insertion: [0.004, 0.0],
    bud: [20.0, 0.0, -8.0],
    open: [30.0, 50.0, 80.0],
    wilted: [60.0, 100.0, 140.0],
    delay: 0.0,
    phase: 0.0,
    lean: 0.002,
    colors: [[0.8; 3]; 2],
    green: 0.0,
    sepal: false,
    form: None,
};

/// A flower by name: rose, lily, tulip, sunflower or clivia.
///
/// ```
/// assert!(bloom::preset("lily").is_some() && bloom::preset("oak").is_none());
/// ```
pub fn preset(name: &str) -> Option<FlowerSpec> {
    let spec = FlowerSpec {
        name: name.to_owned(),
        whorls: vec![],
        stamens: (0, 0.0, 0.0),
        pistil: 0.0,
        disc: 0.0,
        stalk: 0.25,
        nod: 0.0,
        umbel: 1,
        days: [6.0, 4.0],
        rate: 0.95,
        mesh: [18, 14],
    };
    match name {
        "rose" => Some(rose(spec)),
        "lily" => Some(lily(spec)),
        "tulip" => Some(tulip(spec)),
        "sunflower" => Some(sunflower(spec)),
        "clivia" => Some(clivia(spec)),
        _ => None,
    }
}

fn rose(spec: FlowerSpec) -> FlowerSpec {
    // Six rings of five, the inner ones shorter, later and less open.
    let ring = |k: u32| {
        let t = f64::from(k) / 5.0;
        let mix = |a: f64, b: f64| a + (b - a) * t;
        Whorl {
            count: 5,
            length: mix(0.042, 0.026),
            width: mix(0.058, 0.032),
            widest: 0.7,
            claw: 0.35,
            point: 0.12,
            insertion: [mix(0.0088, 0.0027), mix(0.0, 0.0045)],
            bud: [mix(22.0, 4.0), mix(3.0, 0.0), mix(-14.0, -4.0)],
            open: [mix(66.0, 8.0), mix(48.0, 5.0), mix(104.0, 14.0)],
            wilted: [mix(92.0, 28.0), mix(108.0, 40.0), mix(142.0, 62.0)],
            delay: mix(0.0, 0.3),
            phase: 36.0 * f64::from(k) + 11.0,
            lean: mix(0.0004, 0.0005),
            colors: [[0.62, 0.20, 0.12], [0.58, 0.022, 0.06]],
            ..PLAIN
        }
    };
    let sepals = Whorl {
        count: 5,
        length: 0.027,
        width: 0.0125,
        widest: 0.3,
        claw: 0.75,
        point: 1.0,
        insertion: [0.0104, -0.0010],
        bud: [24.0, 5.0, -10.0],
        open: [95.0, 105.0, 125.0],
        wilted: [100.0, 125.0, 155.0],
        lean: 0.0003,
        phase: 3.0,
        colors: [[0.12, 0.28, 0.05], [0.14, 0.34, 0.07]],
        sepal: true,
        ..PLAIN
    };
    let whorls = core::iter::once(sepals).chain((0..6).map(ring)).collect();
    FlowerSpec {
        whorls,
        stamens: (14, 0.008, 18.0),
        pistil: 0.005,
        stalk: 0.09,
        nod: 34.0,
        mesh: [22, 18],
        ..spec
    }
}

fn lily(spec: FlowerSpec) -> FlowerSpec {
    let outer = Whorl {
        count: 3,
        length: 0.105,
        width: 0.026,
        widest: 0.55,
        claw: 0.35,
        point: 0.9,
        insertion: [0.0065, 0.0],
        bud: [10.0, 1.5, -9.0],
        open: [20.0, 46.0, 128.0],
        wilted: [34.0, 92.0, 158.0],
        lean: 0.0007,
        colors: [[0.66, 0.76, 0.40], [0.92, 0.60, 0.71]],
        green: 0.95,
        ..PLAIN
    };
    let inner = Whorl {
        width: 0.036,
        insertion: [0.0045, 0.0012],
        bud: [8.0, 0.5, -8.5],
        open: [17.0, 42.0, 120.0],
        wilted: [28.0, 82.0, 150.0],
        phase: 60.0,
        delay: 0.06,
        length: 0.102,
        ..outer
    };
    FlowerSpec {
        whorls: vec![outer, inner],
        stamens: (6, 0.078, 17.0),
        pistil: 0.088,
        stalk: 0.13,
        nod: 66.0,
        rate: 1.0,
        ..spec
    }
}

fn tulip(spec: FlowerSpec) -> FlowerSpec {
    let outer = Whorl {
        count: 3,
        length: 0.062,
        width: 0.046,
        widest: 0.52,
        claw: 0.8,
        point: 0.6,
        insertion: [0.0085, 0.0],
        bud: [36.0, -2.0, -22.0],
        open: [66.0, 4.0, 14.0],
        wilted: [94.0, 78.0, 92.0],
        lean: 0.0009,
        colors: [[0.78, 0.50, 0.03], [0.68, 0.045, 0.025]],
        ..PLAIN
    };
    let inner = Whorl {
        insertion: [0.006, 0.0014],
        bud: [34.0, -3.0, -22.0],
        open: [62.0, 2.0, 10.0],
        wilted: [84.0, 62.0, 74.0],
        phase: 60.0,
        length: 0.060,
        ..outer
    };
    FlowerSpec {
        whorls: vec![outer, inner],
        nod: 10.0,
        stamens: (6, 0.022, 14.0),
        pistil: 0.026,
        stalk: 0.09,
        days: [5.0, 4.0],
        ..spec
    }
}

fn sunflower(spec: FlowerSpec) -> FlowerSpec {
    // Petals stand beside one another, not over one another: four rings of 13 around the disc.
    let ring = |k: u32| {
        let t = f64::from(k) / 3.0;
        Whorl {
            count: 13,
            length: 0.075 - 0.01 * t,
            width: 0.022,
            widest: 0.45,
            claw: 0.35,
            point: 0.95,
            insertion: [0.046 - 0.006 * t, 0.006 * t],
            bud: [24.0 - 10.0 * t, -12.0 - 4.0 * t, -28.0 - 4.0 * t],
            open: [84.0 - 8.0 * t, 84.0 - 8.0 * t, 93.0 - 8.0 * t],
            wilted: [96.0 - 12.0 * t, 128.0 - 14.0 * t, 160.0 - 14.0 * t],
            delay: 0.05 * t,
            phase: 27.7 / 4.0 * f64::from(k * 2 % 5) + 3.0 * t,
            lean: 0.0006,
            colors: [[0.78, 0.33, 0.006], [0.88, 0.55, 0.008]],
            green: 0.35,
            ..PLAIN
        }
    };
    // Two rings of bracts hold the bud.
    let bracts = |k: u32| {
        let t = f64::from(k);
        Whorl {
            count: 13,
            length: 0.058 - 0.004 * t,
            width: 0.027,
            widest: 0.35,
            claw: 0.9,
            point: 1.0,
            insertion: [0.0485 - 0.0015 * t, -0.0035 + 0.0017 * t],
            bud: [46.0 - 4.0 * t, -6.0 - 3.0 * t, -34.0 - 3.0 * t],
            open: [95.0 - 3.0 * t, 104.0 - 4.0 * t, 122.0 - 5.0 * t],
            wilted: [102.0 - 3.0 * t, 134.0 - 4.0 * t, 164.0 - 5.0 * t],
            lean: 0.0006,
            phase: 9.0 + 180.0 / 13.0 * t,
            colors: [[0.10, 0.26, 0.04], [0.13, 0.33, 0.06]],
            sepal: true,
            ..PLAIN
        }
    };
    let whorls = (0..2).map(bracts).chain((0..4).map(ring)).collect();
    FlowerSpec {
        whorls,
        disc: 0.042,
        stalk: 0.22,
        nod: 58.0,
        days: [8.0, 6.0],
        rate: 0.75,
        mesh: [12, 6],
        ..spec
    }
}

fn clivia(spec: FlowerSpec) -> FlowerSpec {
    let outer = Whorl {
        count: 3,
        length: 0.062,
        width: 0.015,
        widest: 0.62,
        claw: 0.4,
        point: 0.6,
        insertion: [0.0035, 0.0],
        bud: [9.0, 2.0, -5.0],
        open: [16.0, 26.0, 52.0],
        wilted: [10.0, 6.0, -2.0],
        lean: 0.0004,
        colors: [[0.85, 0.50, 0.06], [0.82, 0.17, 0.02]],
        green: 0.15,
        ..PLAIN
    };
    let inner = Whorl {
        width: 0.021,
        insertion: [0.0024, 0.0008],
        bud: [7.0, 1.0, -4.0],
        open: [13.0, 22.0, 45.0],
        wilted: [7.5, 4.0, -2.0],
        phase: 60.0,
        length: 0.060,
        ..outer
    };
    FlowerSpec {
        whorls: vec![outer, inner],
        stamens: (6, 0.045, 11.0),
        pistil: 0.052,
        stalk: 0.14,
        umbel: 12,
        days: [7.0, 5.0],
        rate: 0.85,
        mesh: [12, 6],
        ..spec
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::GrowthLaw;
    use base::Seed;

    #[test]
    fn petals_never_cross_from_bud_to_wilted() {
        for name in FlowerSpec::PRESETS {
            let spec = preset(name).unwrap();
            let law = GrowthLaw::logistic(name, spec.days[0], spec.rate);
            let mut worst = 0.0_f64;
            let first = spec.at(0.0, &law, Seed::new(1));
            for k in 0..=12 {
                let day = (spec.days[0] + spec.days[1]) * f64::from(k) / 12.0;
                let flower = spec.at(day, &law, Seed::new(1));
                assert_eq!(flower.validate().count(), 0, "{name} at {day}");
                assert_eq!(flower.axes, first.axes, "{name}");
                let kept = |p: &plant::Plant| -> Vec<_> {
                    p.organs.iter().map(|o| (o.kind, o.bearer, o.flower, o.shape, o.key)).collect()
                };
                assert_eq!(kept(&flower), kept(&first), "{name}");
                let share = crate::petal_overlap(&flower, None);
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
            let law = GrowthLaw::logistic(name, spec.days[0], spec.rate);
            let width = |day: f64| {
                let flower = spec.at(day, &law, Seed::new(1));
                let corners: Vec<_> = flower.shapes.iter().map(plant::Shape::corners).collect();
                let across = flower
                    .organs
                    .iter()
                    .flat_map(|o| corners[o.shape.index()].iter().map(|&c| o.frame.place(c, o.scale).x));
                let (low, high) = across.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
                high - low
            };
            let (bud, bloom) = (width(0.0), width(spec.days[0]));
            assert!(bloom > 1.15 * bud, "{name}: {bud} {bloom}");
        }
    }
}
