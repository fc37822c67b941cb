//! Services of JavaScript: time, and a place for complaints.

use burgeon::{Budget, CancelToken, Clock, Run, Serial};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen::prelude::*;

#[cfg(target_arch = "wasm32")]
#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;
    #[wasm_bindgen(js_namespace = console)]
    fn error(text: &str);
}

#[cfg(not(target_arch = "wasm32"))]
fn now() -> f64 {
    0.0
}

/// Share of the usual limits: WASM has 4 GiB of addresses, and a tab mostly less.
const SHARE: f64 = 0.25;

/// Makes a panic report where it occurred.
pub(crate) fn tell_of_panics() {
    #[cfg(target_arch = "wasm32")]
    std::panic::set_hook(Box::new(|info| error(&info.to_string())));
}

/// Computes within `times` the budget.
pub(crate) fn with_budget<T>(times: f64, compute: impl FnOnce(&Run<'_>) -> T) -> T {
    let budget = Budget { times: SHARE * times, raise: None };
    compute(&Run { cancel: &CancelToken::new(), executor: &Serial, clock: &Host, budget })
}

struct Host;

impl Clock for Host {
    fn now_ms(&self) -> f64 {
        now()
    }
}
