//! Services of the browser: time, a sign to stop, a place for complaints.

use burgeon::{Budget, CancelToken, Clock, Executor, Run};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen::prelude::*;

#[cfg(target_arch = "wasm32")]
#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;
    #[wasm_bindgen(js_namespace = console)]
    fn error(text: &str);
    // Set by the worker: it receives the finished share (below 0: not known) and returns true when the page wants the
    // evaluation to stop.
    #[wasm_bindgen(js_namespace = globalThis, js_name = burgeonStop)]
    fn burgeon_stop(share: f64) -> bool;
}

#[cfg(not(target_arch = "wasm32"))]
fn now() -> f64 {
    0.0
}

#[cfg(not(target_arch = "wasm32"))]
fn burgeon_stop(_share: f64) -> bool {
    false
}

/// Limits of a page: a tab has 4 GiB of addresses and mostly 1 to 2 GiB of memory, and one that runs out of it dies
/// with its plant. So the budget is a quarter of the usual, 1 GiB, and larger requests get an error.
const BUDGET: Budget = Budget { times: 0.25, raise: None };

/// Makes a panic report where it occurred before the worker dies.
pub(crate) fn tell_of_panics() {
    #[cfg(target_arch = "wasm32")]
    std::panic::set_hook(Box::new(|info| error(&info.to_string())));
}

/// Computes with the browser's clock, within its budget, until the page wants something else.
pub(crate) fn page_run<T>(compute: impl FnOnce(&Run<'_>) -> T) -> T {
    let cancel = CancelToken::new();
    let attentive = Attentive(&cancel);
    compute(&Run { cancel: &cancel, executor: &attentive, clock: &attentive, budget: BUDGET })
}

/// Reports to the page and checks for its wish to stop before each job, and whenever a stage reads the clock: nothing
/// can interrupt the only thread from outside.
struct Attentive<'a>(&'a CancelToken);

impl Attentive<'_> {
    fn look(&self) {
        if burgeon_stop(self.0.share().unwrap_or(-1.0)) {
            self.0.cancel();
        }
    }
}

impl Clock for Attentive<'_> {
    fn now_ms(&self) -> f64 {
        self.look();
        now()
    }
}

impl Executor for Attentive<'_> {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        for i in 0..n {
            self.look();
            job(i);
        }
    }
}
