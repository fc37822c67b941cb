//! Errors as a code with fields, so that programs can tell them apart and every language has its own words.

use std::collections::BTreeMap;

/// What an error is, and what its sentence is filled with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Told {
    /// A word in kebab-case that never changes its meaning.
    pub code: &'static str,
    /// Names and values, as people read them.
    pub fields: BTreeMap<&'static str, String>,
}

/// A code, and the names of its fields.
pub type Code = (&'static str, &'static [&'static str]);

/// An error that has a code for each of its variants. Made by [`crate::coded!`].
pub trait Coded {
    /// Every code that [`Coded::told`] may give.
    fn codes(all: &mut Vec<Code>);

    /// The code of this error, with its fields.
    fn told(&self) -> Told;
}

/// Gives each variant of an error its code and its fields; those that wrap another error have the other's.
///
/// A variant that is forgotten does not compile.
///
/// ```
/// use base::Coded;
/// enum DoorError {
///     Locked(String),
///     Broken,
/// }
/// base::coded!(DoorError {
///     Self::Locked(key) => "door-locked" { key },
///     Self::Broken => "door-broken" {},
/// });
/// let told = DoorError::Locked("brass".into()).told();
/// assert_eq!((told.code, told.fields["key"].as_str()), ("door-locked", "brass"));
/// # let _ = DoorError::Broken;
/// ```
#[macro_export]
macro_rules! coded {
    (@value $field:ident) => { $field };
    (@value $field:ident $value:expr) => { $value };
    ($type:ty {
        $($pattern:pat => $code:literal { $($field:ident $(= $value:expr)?),* }),* $(,)?
    } $(wraps { $($wrap:pat => $inner:expr, $kind:ty);* $(;)? })?) => {
        impl $crate::Coded for $type {
            fn codes(all: &mut Vec<$crate::Code>) {
                let own: &[$crate::Code] = &[$(($code, &[$(stringify!($field)),*])),*];
                all.extend_from_slice(own);
                $($(<$kind as $crate::Coded>::codes(all);)*)?
            }

            fn told(&self) -> $crate::Told {
                match self {
                    $($pattern => $crate::Told {
                        code: $code,
                        fields: [$((stringify!($field), $crate::coded!(@value $field $($value)?).to_string())),*]
                            .into_iter()
                            .collect(),
                    },)*
                    $($($wrap => $crate::Coded::told($inner),)*)?
                }
            }
        }
    };
}
