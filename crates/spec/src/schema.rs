//! The schema of a type, made once.

use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// A maker's spec, or a part of one that is checked by itself. [`schemas!`](crate::schemas) implements it.
pub trait Spec: JsonSchema + Serialize + DeserializeOwned {
    /// Its JSON Schema, with meaning, unit (`x-unit`), range and default of each field. Made at the first call.
    fn schema() -> &'static Value;
}

/// Implements [`Spec`] for types that derive `JsonSchema`, `Serialize` and `Deserialize`.
///
/// ```
/// use spec::Spec;
/// #[derive(schemars::JsonSchema, serde::Serialize, serde::Deserialize)]
/// struct Pot {
///     #[schemars(range(min = 0.0, max = 2.0), extend("x-unit" = "m"))]
///     height_m: f64,
/// }
/// spec::schemas!(Pot);
/// assert_eq!(Pot::schema()["properties"]["height_m"]["maximum"], 2.0);
/// assert_eq!(spec::check(&Pot { height_m: 3.0 }).unwrap_err().to_string(), "height_m must be 0 to 2 m, not 3");
/// ```
#[macro_export]
macro_rules! schemas {
    ($($spec:ty),* $(,)?) => {$(
        impl $crate::Spec for $spec {
            fn schema() -> &'static $crate::serde_json::Value {
                static KEPT: std::sync::OnceLock<$crate::serde_json::Value> = std::sync::OnceLock::new();
                KEPT.get_or_init($crate::made_schema::<Self>)
            }
        }
    )*};
}

/// The schema of a type, made anew.
pub fn made_schema<T: JsonSchema>() -> Value {
    schemars::SchemaGenerator::default().into_root_schema_for::<T>().to_value()
}
