//! Errors as a code with fields, so that programs can tell them apart and every language has its own words.

use core::fmt::Display;
use std::collections::BTreeMap;

/// Code of an error, with the fields of its sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Told {
    /// A word in kebab-case that never changes its meaning.
    pub code: &'static str,
    /// Names and values, as people read them.
    pub fields: BTreeMap<&'static str, String>,
    /// The fields that are errors themselves.
    pub causes: BTreeMap<&'static str, Self>,
}

impl Told {
    /// Serves [`crate::coded!`]. It is a function and not part of the macro, so that one copy serves all errors.
    #[doc(hidden)]
    pub fn new(code: &'static str, fields: &[(&'static str, &dyn Display)]) -> Self {
        let mut told = Self { code, fields: BTreeMap::new(), causes: BTreeMap::new() };
        told.fields.extend(fields.iter().map(|(name, value)| (*name, value.to_string())));
        told
    }

    /// Adds `cause` to the fields that are errors themselves, if there is one.
    #[doc(hidden)]
    #[inline]
    #[must_use]
    pub fn with(self, cause: Option<(&'static str, Self)>) -> Self {
        match cause {
            Some((field, cause)) => self.because(field, cause),
            None => self,
        }
    }

    fn because(mut self, field: &'static str, cause: Self) -> Self {
        self.causes.insert(field, cause);
        self
    }
}

/// A code, and the names of its fields.
pub type Code = (&'static str, &'static [&'static str]);

/// An error that has a code for each of its variants. Made by [`crate::coded!`].
pub trait Coded {
    /// Appends every code that [`Coded::details`] may return.
    fn codes(all: &mut Vec<Code>);

    /// Returns the code of this error, with its fields.
    fn details(&self) -> Told;
}

/// Gives each variant of an error its code and its fields; those that wrap another error have the other's.
///
/// A variant that is forgotten does not compile. A field that is an error with codes of its own says its type.
///
/// ```
/// use base::Coded;
/// use core::fmt::{Display, Formatter, Result};
/// enum DoorError {
///     Locked(String),
///     Broken,
/// }
/// base::coded!(DoorError {
///     Self::Locked(key) => "door-locked" { key },
///     Self::Broken => "door-broken" {},
/// });
/// impl Display for DoorError {
///     fn fmt(&self, f: &mut Formatter<'_>) -> Result {
///         f.write_str("it does not open")
///     }
/// }
/// struct HouseError(DoorError);
/// base::coded!(HouseError {
///     Self(door) => "house" { why = door => DoorError },
/// });
/// let told = HouseError(DoorError::Locked("brass".into())).details();
/// assert_eq!((told.code, told.fields["why"].as_str()), ("house", "it does not open"));
/// let why = &told.causes["why"];
/// assert_eq!((why.code, why.fields["key"].as_str()), ("door-locked", "brass"));
/// # let _ = DoorError::Broken;
/// ```
#[macro_export]
macro_rules! coded {
    (@value $field:ident) => { $field };
    (@value $field:ident $value:expr) => { $value };
    (@cause $field:ident [$($value:expr)?]) => { None };
    (@cause $field:ident [] $cause:ty) => { $crate::coded!(@cause $field [$field] $cause) };
    (@cause $field:ident [$value:expr] $cause:ty) => {
        Some((stringify!($field), <$cause as $crate::Coded>::details($value)))
    };
    ($type:ty {
        $($pattern:pat => $code:literal { $($field:ident $(= $value:expr)? $(=> $cause:ty)?),* }),* $(,)?
    } $(wraps { $($wrap:pat => $inner:expr, $kind:ty);* $(;)? })?) => {
        impl $crate::Coded for $type {
            fn codes(all: &mut Vec<$crate::Code>) {
                let own: &[$crate::Code] = &[$(($code, &[$(stringify!($field)),*])),*];
                // An error may hold one of its own kind.
                if !own.is_empty() && own.iter().all(|code| all.contains(code)) {
                    return;
                }
                all.extend_from_slice(own);
                $($($(<$cause as $crate::Coded>::codes(all);)?)*)*
                $($(<$kind as $crate::Coded>::codes(all);)*)?
            }

            fn details(&self) -> $crate::Told {
                match self {
                    $($pattern => $crate::Told::new(
                        $code,
                        &[$((stringify!($field), &$crate::coded!(@value $field $($value)?))),*],
                    )$(.with($crate::coded!(@cause $field [$($value)?] $($cause)?)))*,)*
                    $($($wrap => $crate::Coded::details($inner),)*)?
                }
            }
        }
    };
}
