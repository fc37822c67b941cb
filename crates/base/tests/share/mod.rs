//! Samples of test cases, for tests whose sample is nearly as informative as the whole.

/// Returns every `step`th item from `first` on, or all items if `BURGEON_TESTS=all` is set, as `cargo xtask test --all`
/// does.
pub(crate) fn sample<T>(all: &[T], first: usize, step: usize) -> Vec<&T> {
    let [first, step] = if is_all() { [0, 1] } else { [first, step] };
    all.iter().skip(first).step_by(step).collect()
}

fn is_all() -> bool {
    std::env::var_os("BURGEON_TESTS").is_some_and(|asked| asked == "all")
}
