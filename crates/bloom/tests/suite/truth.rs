//! Series of known truth: petals of our own flowers that open by known laws, measured with noise.
#![expect(clippy::unwrap_used, clippy::panic, reason = "tests")]

use base::{Draw, Run, Seed};
use bloom::{
    FlowerSpec, Form, GrowthLaw, LawSpec, Logistic, MotionSpec, Nods, Quantity, RegionLaw, Rival, ScanOrgan,
    Stage,
};
use bloom::{fit_stages, leave_one_out, preset, settle};
use glam::DVec3;
use plant::{OrganKind, Shape};

/// Makes a lily whose head nods as it opens, by the same law: motion at another pace than its petals' is not growth.
fn lily() -> FlowerSpec {
    FlowerSpec { nods: Nods::default(), ..preset("lily").unwrap() }
}

/// Returns the outer petals of a lily on a day, each an organ with `noise` on every point.
fn stage(day: f64, law: &GrowthLaw, noise: f64) -> Stage {
    let plant = lily().make_on_day(day, law, Seed::new(1));
    let petals = plant.organs.iter().filter(|o| o.kind == OrganKind::Petal);
    let mut s = Seed::new(day.to_bits()).stream(Draw::Test);
    let organs = petals.take(3).enumerate().map(|(k, o)| {
        let Shape::Sheet(sheet) = &plant.shapes[o.shape.index()] else { panic!("a petal is a sheet") };
        let at: Vec<DVec3> = sheet.points.iter().map(|&p| o.frame.place(p, o.scale)).collect();
        let mut jitter = || noise * DVec3::new(s.range(-1.0, 1.0), s.range(-1.0, 1.0), s.range(-1.0, 1.0));
        // The joint itself, and the path that the sheet knows.
        ScanOrgan {
            name: format!("petal-{}", k + 1),
            colors: Vec::new(),
            rows: (0..at.len()).collect(),
            base: at[0],
            tip: at[at.len() - 1],
            points: at.iter().map(|p| *p + jitter()).collect(),
            way: sheet.points.iter().enumerate().map(|(i, _)| i as f64 / at.len() as f64).collect(),
            ..ScanOrgan::default()
        }
    });
    Stage { day, organs: organs.collect() }
}

fn stages(days: &[f64], law: &GrowthLaw, noise: f64) -> Vec<Stage> {
    days.iter().map(|&d| stage(d, law, noise)).collect()
}

#[test]
fn a_flower_that_opens_by_a_law_gives_its_pace_back() {
    let run = Run::plain();
    let spec = preset("lily").unwrap();
    let law = spec.own_law();
    let last = law.span_days;
    for (days, limit) in
        [(vec![0.0, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0], 0.08), (vec![0.0, 0.25, 0.5, 0.75, 1.0], 0.12)]
    {
        let days: Vec<f64> = days.iter().map(|d| d * last).collect();
        let made = stages(&days, &law, 1e-4);
        let settled = settle(&made, &MotionSpec::default().register, &run).unwrap();
        let got = fit_stages("lily", &settled.stages, &LawSpec::default(), &Run::plain()).unwrap();
        let able = got.laws.iter().filter(|l| l.is_determined()).count();
        let mut worst = 0.0_f64;
        for k in 1..10 {
            let day = last * f64::from(k) / 10.0;
            let want = law.progress("petal", Quantity::Size, 0.5, 0.0, last, day);
            worst = worst.max((got.pace_at("petal-1", 0.5, 0.0, last, day) - want).abs());
        }
        println!(
            "{} days: {able} of {} laws determined, pace off by at most {worst:.3}",
            days.len(),
            got.laws.len()
        );
        assert!(able * 2 > got.laws.len(), "{able} of {}", got.laws.len());
        assert!(worst < limit, "{worst}");
    }
}

#[test]
fn a_day_that_is_left_out_is_nearer_to_the_model_than_to_its_rivals() {
    let run = Run::plain();
    let law = preset("lily").unwrap().own_law();
    let days: Vec<f64> = [0.0, 0.25, 0.5, 0.75, 1.0].iter().map(|d| d * law.span_days).collect();
    let trials =
        leave_one_out(&stages(&days, &law, 1e-4), &LawSpec::default(), &MotionSpec::default(), None, &run)
            .unwrap();
    let (mut sums, mut between) = ([[0.0; 2]; 4], 0);
    for t in &trials {
        println!("day {:.2}{}", t.day, if t.extrapolated { ", extrapolated" } else { "" });
        for (row, sum) in t.rows.iter().zip(&mut sums) {
            let [a, b] = [row.aligned.to_model.mean, row.aligned.to_scan.mean].map(|d| d * 1e3);
            println!(
                "  {:<23} {a:.2} / {b:.2}, as it stands {:.2}",
                row.rival.word(),
                row.scanner.to_model.mean * 1e3
            );
            if !t.extrapolated {
                *sum = [sum[0] + a, sum[1] + b];
            }
        }
        between += u32::from(!t.extrapolated);
    }
    assert_eq!(between, 3);
    for (rival, sum) in Rival::ALL.iter().zip(&sums).skip(1) {
        assert!(sums[0][0] < sum[0] && sums[0][1] < sum[1], "{}: {sums:?}", rival.word());
    }
}

/// Makes a law of three regions with a rate each, and of the size.
fn regions(rates: [f64; 3], determined: bool) -> GrowthLaw {
    let mut law = GrowthLaw::logistic("made", 6.0, 0.95);
    law.regions = 3;
    let row = |region, axis, r| RegionLaw {
        organ: "any".into(),
        region,
        axis,
        form: Form::Logistic,
        law: Logistic { k: 1.0, p0: 0.05, r, offset: 0.0 },
        determined: Some(determined),
        straight_rmse: None,
        last_rmse: None,
        standard_errors: None,
        value_errors: None,
        r2: 1.0,
        r2_adjusted: None,
        loo_rmse: None,
        days: vec![],
        values: vec![],
    };
    law.laws[0].determined = Some(determined);
    law.laws.extend(rates.into_iter().enumerate().map(|(k, r)| row(k + 1, Quantity::Y, r)));
    law
}

#[test]
fn laws_of_regions_open_a_petal_region_by_region() {
    // Its petals turn at their base as well as at their tip; those of a lily hardly do.
    let tulip = preset("tulip").unwrap();
    let points = |law: &GrowthLaw| {
        let plant = tulip.make_on_day(3.0, law, Seed::new(1));
        assert!(bloom::part_overlap(&plant, None) <= 0.0, "no petal crosses another");
        let first = plant.organs.iter().find(|o| o.kind == OrganKind::Petal).unwrap().clone();
        let Shape::Sheet(sheet) = &plant.shapes[first.shape.index()] else { panic!("a petal is a sheet") };
        sheet.points.iter().map(|&p| first.frame.place(p, first.scale)).collect::<Vec<DVec3>>()
    };
    let even = points(&regions([0.95; 3], true));
    let apart = |other: &[DVec3], rows: core::ops::Range<usize>| {
        rows.clone().map(|i| even[i].distance(other[i])).sum::<f64>() / rows.len() as f64
    };
    let n = even.len();
    let tip = points(&regions([0.95, 0.95, 3.0], true));
    let (low, high) = (apart(&tip, 0..n / 6), apart(&tip, n - n / 6..n));
    println!("the tip's law moves the base by {:.2} mm and the tip by {:.2} mm", low * 1e3, high * 1e3);
    assert!(high > 1e-3 && high > 5.0 * low, "{low} {high}");
    let base = points(&regions([3.0, 0.95, 0.95], true));
    assert!(apart(&base, n - n / 6..n) > 1e-3, "the tip goes with the base");
    // Parameters that the stages do not determine open nothing: the pace is even.
    let none = regions([0.95, 0.95, 3.0], false);
    assert!(!none.sets_pace() && regions([0.95; 3], true).sets_pace());
    let even_pace = points(&GrowthLaw::even(0.0, 6.0));
    assert!(points(&none).iter().zip(&even_pace).all(|(a, b)| a.distance(*b) < 1e-12));
}
