//! How much tests ask where a part of it says nearly as much as all.

/// Every `step`th of all, from row `first` on; all of them where `BURGEON_TESTS=all` asks for it, as `cargo xtask test --all` does.
pub(crate) fn sample<T>(all: &[T], first: usize, step: usize) -> Vec<&T> {
    let [first, step] = if is_all() { [0, 1] } else { [first, step] };
    all.iter().skip(first).step_by(step).collect()
}

fn is_all() -> bool {
    std::env::var_os("BURGEON_TESTS").is_some_and(|asked| asked == "all")
}
