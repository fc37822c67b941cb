/// Defines a typed `u32` handle into a column or arena.
///
/// ```
/// base::define_id! {
///     /// One leaf.
///     pub struct LeafId;
/// }
/// let id = LeafId::new(3);
/// assert_eq!((id.index(), id.to_string()), (3, "LeafId(3)".to_string()));
/// ```
#[macro_export]
macro_rules! define_id {
    ($(#[$doc:meta])* $vis:vis struct $name:ident;) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        $vis struct $name(u32);

        impl $name {
            /// Creates the handle of row `index`.
            ///
            /// # Panics
            /// If `index` does not fit in `u32`: four billion rows are a bug, not data.
            #[inline]
            pub const fn new(index: usize) -> Self {
                assert!(index <= u32::MAX as usize, "more rows than a u32 handle can name");
                #[expect(clippy::cast_possible_truncation, reason = "checked on the line above")]
                Self(index as u32)
            }

            /// Returns the row that this handle names.
            #[inline]
            pub const fn index(self) -> usize {
                self.0 as usize
            }

            /// Returns the handle as it is written to files.
            #[inline]
            pub const fn raw(self) -> u32 {
                self.0
            }
        }

        impl ::core::fmt::Display for $name {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                write!(f, concat!(stringify!($name), "({})"), self.0)
            }
        }
    };
}
