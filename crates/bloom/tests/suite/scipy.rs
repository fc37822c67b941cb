//! The logistic fit against `scipy.optimize.curve_fit` (scipy 1.17.1, method lm, tolerances 1e-15, analytic
//! Jacobian, the best of 72 starts).
#![expect(clippy::unwrap_used, clippy::panic, reason = "tests")]

use crate::missing;
use bloom::{Offset, fit_law, fit_logistic};

fn numbers(text: &str) -> Vec<f64> {
    text.split(',').map(|w| w.parse().unwrap()).collect()
}

/// Whether two values agree, relative to the value but never finer than a thousandth of its standard error: a parameter
/// that the series does not determine is not determined by scipy either.
fn close(got: f64, want: f64, standard_error: f64) -> bool {
    (got - want).abs() <= 1e-6 * want.abs().max(standard_error)
}

#[test]
fn a_thousand_made_series_fit_as_scipy_fits_them() {
    let text = include_str!("../../../../fixtures/bloom/logistic.csv");
    let mut seen = 0;
    let mut worst = (0.0_f64, String::new());
    for line in text.lines().filter(|l| !l.starts_with('#')) {
        let cells: Vec<&str> = line.split(';').collect();
        let (x, y) = (numbers(cells[1]), numbers(cells[2]));
        let (want, errors) = (numbers(cells[3]), numbers(cells[4]));
        let sse: f64 = cells[5].parse().unwrap();
        let fit = fit_law(&x, &y, Offset::Zero).unwrap();
        assert!(fit.sse <= sse * (1.0 + 1e-9), "{}: {} above scipy's {sse}", cells[0], fit.sse);
        let got = [fit.law.k, fit.law.p0, fit.law.r];
        let se = fit.standard_errors.unwrap_or_else(|| panic!("{} has no standard errors", cells[0]));
        for i in 0..3 {
            let off = (got[i] - want[i]).abs() / want[i].abs().max(errors[i]);
            if off > worst.0 {
                worst = (off, cells[0].to_owned());
            }
            assert!(close(got[i], want[i], errors[i]), "{} parameter {i}: {got:?} {want:?}", cells[0]);
            assert!(
                (se[i] - errors[i]).abs() <= 1e-5 * errors[i],
                "{} error of parameter {i}: {se:?} {errors:?}",
                cells[0]
            );
        }
        seen += 1;
    }
    println!("{seen} series, worst relative difference {:.1e} ({})", worst.0, worst.1);
    assert_eq!(seen, 1000);
}

/// K, p0, r, their standard errors and the sum of squares by scipy; the tables themselves are not ours to copy.
const GROWTH: [(&str, [f64; 7]); 6] = [
    (
        "sunflower",
        [264.28189267, 12.3101786577, 0.0878999344681, 2.02515639921, 1.10980588152, 0.002819625955, 0.0],
    ),
    (
        "1",
        [
            154.163048601,
            23.2180767849,
            0.00275807513906,
            11.3317889457,
            5.33238167315,
            0.000514927443616,
            176.99486168,
        ],
    ),
    (
        "2",
        [
            218.998305051,
            23.7573443713,
            0.00300757831358,
            14.2714142629,
            5.82627407587,
            0.000477242174688,
            290.718940358,
        ],
    ),
    (
        "3",
        [
            158.829454191,
            21.9047020689,
            0.00249404595284,
            15.0851447457,
            4.7797559134,
            0.000462349286951,
            156.670804354,
        ],
    ),
    (
        "4",
        [
            225.30387791,
            19.7159123405,
            0.00329876248732,
            14.6406190325,
            6.04187928726,
            0.000559935865414,
            389.51065117,
        ],
    ),
    (
        "5",
        [
            207.257888694,
            19.4616526613,
            0.0026319534848,
            22.2369923727,
            5.09981325277,
            0.000466896025383,
            259.700112259,
        ],
    ),
];

#[test]
fn the_growth_tables_fit_as_scipy_fits_them() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/growth");
    if !folder.is_dir() {
        return missing::skipped(folder.display());
    }
    let cell = |w: &str| w.trim_matches('"').parse::<f64>().unwrap();
    for (name, want) in GROWTH {
        let file = if name == "sunflower" { "sunflower_height.csv" } else { "Orange.csv" };
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|l| l.split(',').collect()).collect();
        let (x, y): (Vec<f64>, Vec<f64>) = if name == "sunflower" {
            rows.iter().map(|r| (cell(r[0]), cell(r[1]))).unzip()
        } else {
            rows.iter().filter(|r| r[1].trim_matches('"') == name).map(|r| (cell(r[2]), cell(r[3]))).unzip()
        };
        let fit = fit_logistic(&x, &y, Offset::Auto).unwrap();
        let got = [fit.law.k, fit.law.p0, fit.law.r];
        let errors = fit.standard_errors.unwrap();
        for i in 0..3 {
            assert!((got[i] - want[i]).abs() <= 1e-6 * want[i].abs(), "{name}: {got:?} {want:?}");
            assert!((errors[i] - want[i + 3]).abs() <= 1e-5 * want[i + 3], "{name}: {errors:?}");
        }
        assert!(want[6] <= 0.0 || (fit.sse - want[6]).abs() <= 1e-6 * want[6], "{name}: {}", fit.sse);
        println!(
            "{name}: K {:.3} p0 {:.3} r {:.5} R2 {:.4} adjusted {:.4} leave-one-out {:.3}",
            got[0],
            got[1],
            got[2],
            fit.r2,
            fit.r2_adjusted.unwrap(),
            fit.loo_rmse.unwrap()
        );
    }
}

#[test]
fn leave_one_out_is_each_value_predicted_from_the_others() {
    let x = [0.0, 3.0, 5.0, 8.0, 11.0, 16.0];
    let y = [1.1, 2.9, 4.4, 7.3, 8.6, 9.8];
    let mut sum = 0.0;
    for out in 0..6 {
        let keep = |v: &[f64; 6]| (0..6).filter(|&i| i != out).map(|i| v[i]).collect::<Vec<f64>>();
        let law = fit_law(&keep(&x), &keep(&y), Offset::Zero).unwrap().law;
        sum += (law.value(x[out]) - y[out]) * (law.value(x[out]) - y[out]);
    }
    let fit = fit_logistic(&x, &y, Offset::Zero).unwrap();
    assert!((fit.loo_rmse.unwrap() - (sum / 6.0).sqrt()).abs() < 1e-12);
    let adjusted = 1.0 - (1.0 - fit.r2) * 5.0 / 3.0;
    assert!((fit.r2_adjusted.unwrap() - adjusted).abs() < 1e-12);
}

#[test]
fn decreasing_constant_and_sign_changing_series() {
    use bloom::{FitError, Logistic};
    let days: Vec<f64> = (0..9).map(f64::from).collect();
    let of = |law: Logistic| days.iter().map(|&d| law.value(d)).collect::<Vec<f64>>();
    let decay = Logistic { k: 2.0, p0: 9.0, r: 0.6, offset: 0.0 };
    let fit = fit_logistic(&days, &of(decay), Offset::Auto).unwrap();
    assert!((fit.law.k - 2.0).abs() < 1e-7 && (fit.law.p0 - 9.0).abs() < 1e-7, "{fit:?}");
    let down = Logistic { k: -5.0, p0: -0.5, r: 0.9, offset: 0.0 };
    let fit = fit_logistic(&days, &of(down), Offset::Auto).unwrap();
    assert!((fit.law.r - 0.9).abs() < 1e-7 && fit.law.offset.abs() <= 0.0, "{fit:?}");
    let crossing = of(Logistic { k: 10.0, p0: 1.0, r: 0.8, offset: -6.0 });
    assert_eq!(fit_logistic(&days, &crossing, Offset::Zero), Err(FitError::Sign));
    for sign in [1.0, -1.0] {
        let y: Vec<f64> = crossing.iter().map(|v| v * sign).collect();
        let fit = fit_logistic(&days, &y, Offset::Auto).unwrap();
        assert!(fit.r2 > 0.995 && (fit.law.value(8.0) - y[8]).abs() < 0.3, "{fit:?}");
    }
    let fit = fit_logistic(&days, &[3.0; 9], Offset::Auto).unwrap();
    assert!((fit.law.value(100.0) - 3.0).abs() < 1e-12 && fit.r2 >= 1.0, "{fit:?}");
    let fit = fit_logistic(&days, &[0.0; 9], Offset::Auto).unwrap();
    assert!(fit.law.value(4.0).abs() <= 0.0, "{fit:?}");
    let three = fit_logistic(&[0.0, 1.0, 5.0], &[10.0, 12.0, 19.0], Offset::Auto).unwrap();
    assert!(
        three.r2 > 1.0 - 1e-12 && three.standard_errors.is_none() && three.loo_rmse.is_none(),
        "{three:?}"
    );
}

#[test]
fn bad_series_are_named() {
    use bloom::FitError;
    let fit = |d: &[f64], v: &[f64]| fit_logistic(d, v, Offset::Auto).unwrap_err();
    assert_eq!(fit(&[0.0, 1.0], &[1.0, 2.0]), FitError::TooFew { got: 2 });
    assert_eq!(fit(&[0.0, 2.0, 1.0], &[1.0; 3]), FitError::Order { day: 1.0, before: 2.0 });
    assert_eq!(fit(&[0.0, 1.0, 2.0], &[1.0, f64::NAN, 1.0]), FitError::NotFinite { index: 1 });
    assert_eq!(fit(&[0.0, 1.0, 2.0], &[1.0]), FitError::Length { days: 3, values: 1 });
}

proptest::proptest! {
    #[test]
    fn any_finite_series_gives_a_finite_law(
        steps in proptest::collection::vec(1e-6..1e3_f64, 3..30),
        values in proptest::collection::vec(proptest::prop_oneof![-1e6..1e6_f64, proptest::strategy::Just(0.0), 1e-12..1e-9_f64], 30),
        start in -1e4..1e4_f64,
    ) {
        let days: Vec<f64> = steps.iter().scan(start, |d, s| { *d += s; Some(*d) }).collect();
        let fit = fit_logistic(&days, &values[..days.len()], Offset::Auto).unwrap();
        for &d in &days {
            proptest::prop_assert!(fit.law.value(d).is_finite(), "{fit:?}");
        }
        proptest::prop_assert!(fit.r2 <= 1.0 + 1e-12, "{fit:?}");
    }
}
