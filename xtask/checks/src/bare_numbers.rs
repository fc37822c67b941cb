//! `cargo xtask habits`: in the crate that interprets strokes, a number in a comparison has a name.
//!
//! A name says what the number separates, in which unit and where it comes from; a bare number says nothing, and the
//! same threshold gets two values in two places. Numbers of plain geometry stay: zero, one, two, a half, and the three
//! corners of a polygon.

use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};
use syn::{
    Attribute, BinOp, Expr, ExprBinary, ExprClosure, ExprMethodCall, ImplItemFn, ItemFn, ItemMod, Lit,
};

use xtask::shell::{Outcome, repository, say};

/// The folder whose comparisons are checked.
const FOLDER: &str = "crates/reading/src";
/// Numbers of plain geometry.
const PLAIN: [&str; 4] = ["0", "1", "2", "0.5"];
/// Number of plain geometry in counts of points only.
const CORNERS: &str = "3";

/// Fails if a comparison has a number without a name.
pub(crate) fn check() -> Outcome {
    let mut faults = Vec::new();
    let mut looked = 0;
    let files = sources(&repository().join(FOLDER))?;
    for file in files.into_iter().filter(|f| f.file_name().is_none_or(|n| n != "tests.rs")) {
        let text = std::fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
        let place = file.strip_prefix(repository()).unwrap_or(&file).display().to_string();
        let seen = bare(&text).map_err(|e| format!("{place}: {e}"))?;
        looked += seen.compared;
        faults.extend(seen.bare.into_iter().map(|b| format!("{place}: {b}")));
    }
    if faults.is_empty() {
        say(&format!("bare numbers: none in {looked} comparisons of {FOLDER}"));
        return Ok(());
    }
    Err(format!(
        "{} comparisons with numbers that have no name (give each a constant that says its unit, what it separates and where \
         it comes from):\n  {}",
        faults.len(),
        faults.join("\n  ")
    ))
}

/// Returns the folders of crates and shells.
pub(crate) fn packages() -> Outcome<Vec<PathBuf>> {
    let mut all = Vec::new();
    for folder in ["crates", "apps"] {
        let folder = repository().join(folder);
        let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        all.extend(entries.filter_map(Result::ok).map(|e| e.path()));
    }
    Ok(all)
}

/// Returns the sources of a folder and those below.
pub(crate) fn sources(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let fault = |e: &dyn core::fmt::Display| format!("{}: {e}", folder.display());
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|e| fault(&e))? {
        let path = entry.map_err(|e| fault(&e))?.path();
        if path.is_dir() {
            found.extend(sources(&path)?);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Findings in a source.
#[derive(Default)]
struct Seen {
    compared: usize,
    /// The function and the numbers.
    bare: Vec<String>,
    function: String,
}

fn bare(text: &str) -> Result<Seen, syn::Error> {
    let mut seen = Seen::default();
    seen.visit_file(&syn::parse_file(text)?);
    Ok(seen)
}

impl Seen {
    fn compare(&mut self, sides: &[&Expr]) {
        self.compared += 1;
        let mut numbers = Numbers::default();
        sides.iter().for_each(|s| numbers.visit_expr(s));
        let counts = sides
            .iter()
            .any(|s| matches!(s, Expr::MethodCall(c) if c.method == "len" || c.method == "count"));
        let plain = |n: &&String| !(PLAIN.contains(&n.as_str()) || counts && *n == CORNERS);
        let named: Vec<&str> = numbers.found.iter().filter(plain).map(String::as_str).collect();
        if !named.is_empty() {
            self.bare.push(format!("{} compares with {}", self.function, named.join(", ")));
        }
    }
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|a| {
        a.path().is_ident("test")
            || a.path().is_ident("cfg") && a.parse_args::<syn::Path>().is_ok_and(|p| p.is_ident("test"))
    })
}

impl<'a> Visit<'a> for Seen {
    fn visit_item_mod(&mut self, module: &'a ItemMod) {
        if !is_test(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_item_fn(&mut self, item: &'a ItemFn) {
        if !is_test(&item.attrs) {
            let outer = core::mem::replace(&mut self.function, item.sig.ident.to_string());
            visit::visit_item_fn(self, item);
            self.function = outer;
        }
    }

    fn visit_impl_item_fn(&mut self, item: &'a ImplItemFn) {
        self.function = item.sig.ident.to_string();
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_expr_binary(&mut self, e: &'a ExprBinary) {
        if is_comparison(&e.op) {
            self.compare(&[&e.left, &e.right]);
        }
        visit::visit_expr_binary(self, e);
    }

    /// Checks `(low..high).contains(&x)`.
    fn visit_expr_method_call(&mut self, e: &'a ExprMethodCall) {
        let receiver = match &*e.receiver {
            Expr::Paren(p) => &*p.expr,
            other => other,
        };
        if e.method == "contains" && matches!(receiver, Expr::Range(_)) {
            self.compare(&[receiver]);
        }
        visit::visit_expr_method_call(self, e);
    }
}

const fn is_comparison(op: &BinOp) -> bool {
    matches!(op, BinOp::Lt(_) | BinOp::Le(_) | BinOp::Gt(_) | BinOp::Ge(_) | BinOp::Eq(_) | BinOp::Ne(_))
}

/// Numbers of one side of a comparison, except those of comparisons and of closures inside.
#[derive(Default)]
struct Numbers {
    found: Vec<String>,
}

impl<'a> Visit<'a> for Numbers {
    fn visit_expr_binary(&mut self, e: &'a ExprBinary) {
        if !is_comparison(&e.op) {
            visit::visit_expr_binary(self, e);
        }
    }

    fn visit_expr_closure(&mut self, _: &'a ExprClosure) {}

    fn visit_expr_index(&mut self, _: &'a syn::ExprIndex) {}

    fn visit_lit(&mut self, lit: &'a Lit) {
        match lit {
            Lit::Int(n) => self.found.push(n.base10_digits().to_owned()),
            Lit::Float(x) => {
                let digits = x.base10_digits();
                self.found.push(digits.strip_suffix(".0").unwrap_or(digits).to_owned());
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(body: &str) -> Vec<String> {
        bare(&format!("fn f(x: f64, v: &[f64]) -> bool {{ {body} }}")).expect("can be parsed").bare
    }

    #[test]
    fn a_number_without_a_name_is_found_on_either_side_and_inside_sums() {
        assert_eq!(found("x < 0.3"), ["f compares with 0.3"]);
        assert_eq!(found("0.25 * x + 4.0 >= x"), ["f compares with 0.25, 4"]);
        assert_eq!(found("x > x.max(0.06)"), ["f compares with 0.06"]);
        assert_eq!(found("(0.3..0.7).contains(&x)"), ["f compares with 0.3, 0.7"]);
        assert_eq!(found("v.len() > 4 && v.iter().all(|y| *y < 0.1)").len(), 2);
    }

    #[test]
    fn names_plain_geometry_and_tests_are_left() {
        assert!(found("x < STRAIGHT && v.len() < 3 && x > 0.0 && 2.0 * x >= 0.5 && x == 1.0").is_empty());
        assert!(found("const FAR: f64 = 0.3; v[7] < FAR && x < FAR * x").is_empty());
        let tests =
            "#[cfg(test)] mod tests { fn f(x: f64) -> bool { x < 0.3 } } #[test] fn g() { h(0.1 < 0.2) }";
        assert!(bare(tests).expect("can be parsed").bare.is_empty());
    }
}
