//! Any bytes as a growth law: what passes its checks has finite values and a finite pace, and is plotted.
#![no_main]

use bloom::{GrowthLaw, Quantity};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(law) = serde_json::from_slice::<GrowthLaw>(bytes) else { return };
    if law.validate().next().is_some() {
        return;
    }
    for day in [0.0, 0.3 * law.span_days, law.span_days] {
        let pace = law.progress("petal", Quantity::Size, 0.5, 0.0, law.span_days, day);
        assert!(pace.is_finite(), "day {day}: {pace}");
    }
    let plot = bloom::plot_svg(&law);
    assert!(plot.contains("</svg>"), "a whole plot");
});
