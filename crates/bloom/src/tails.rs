//! Tails of the distribution of F.

use base::ops;

/// Returns the share of the distribution of F beyond `f`, for degrees of freedom above and below.
pub(crate) fn tail_of_f(f: f64, [above, below]: [f64; 2]) -> f64 {
    incomplete_beta(0.5 * below, 0.5 * above, below / (below + above * f.max(0.0)))
}

/// Returns the regularised incomplete beta function, by its continued fraction (Lentz 1976; Press et al. 2007, section
/// 6.4).
fn incomplete_beta(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return if x >= 1.0 { 1.0 } else { 0.0 };
    }
    let front = ops::exp(ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * ops::ln(x) + b * ops::ln(1.0 - x));
    if x < (a + 1.0) / (a + b + 2.0) {
        front * fraction(a, b, x) / a
    } else {
        1.0 - front * fraction(b, a, 1.0 - x) / b
    }
}

fn fraction(a: f64, b: f64, x: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let away = |x: f64| if x.abs() < TINY { TINY } else { x };
    let mut c = 1.0;
    let mut d = 1.0 / away(1.0 - (a + b) * x / (a + 1.0));
    let mut h = d;
    for m in 1..500 {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        for step in [even, odd] {
            d = 1.0 / away(1.0 + step * d);
            c = away(1.0 + step / c);
            h *= d * c;
        }
        if (d * c - 1.0).abs() < 1e-14 {
            break;
        }
    }
    h
}

/// Returns the logarithm of the gamma function of a positive number (Lanczos 1964).
fn ln_gamma(x: f64) -> f64 {
    const G: [f64; 6] = [
        76.180_091_729_471_46,
        -86.505_320_329_416_77,
        24.014_098_240_830_91,
        -1.231_739_572_450_155,
        0.001_208_650_973_866_179,
        -0.000_005_395_239_384_953,
    ];
    let base = x + 5.5;
    let mut sum = 1.000_000_000_190_015;
    let mut at = x;
    for g in G {
        at += 1.0;
        sum += g / at;
    }
    (x + 0.5) * ops::ln(base) - base + ops::ln(2.506_628_274_631_000_5 * sum / x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tails_of_f_are_those_of_tables() {
        // 5 % points of F (Snedecor and Cochran 1989).
        for (d1, d2, f) in [(1.0, 10.0, 4.965), (3.0, 20.0, 3.098), (6.0, 60.0, 2.254)] {
            let p = tail_of_f(f, [d1, d2]);
            assert!((p - 0.05).abs() < 1e-4, "{d1} {d2}: {p}");
        }
        assert_eq!((incomplete_beta(2.0, 3.0, 0.0), incomplete_beta(2.0, 3.0, 1.0)), (0.0, 1.0));
    }
}
