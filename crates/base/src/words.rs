//! Enums whose choices users write as words: [`words!`](crate::words).

/// Lists the choices of an enum with their words: defines `ALL`, `word` and `from_word`.
///
/// ```
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// pub enum Season { Spring, Autumn }
/// base::words!(Season { Spring = "spring", Autumn = "autumn" });
/// assert_eq!(Season::ALL, [Season::Spring, Season::Autumn]);
/// assert_eq!((Season::Autumn.word(), Season::from_word("spring")), ("autumn", Some(Season::Spring)));
/// assert_eq!((Season::from_word("winter"), Season::words()), (None, "spring or autumn".to_owned()));
/// ```
#[macro_export]
macro_rules! words {
    ($name:ident { $($choice:ident = $word:literal),+ $(,)? }) => {
        impl $name {
            /// Every choice, in the order in which lists have them.
            pub const ALL: [Self; [$($word),+].len()] = [$(Self::$choice),+];

            /// Returns the word that the choice is written as.
            pub const fn word(self) -> &'static str {
                match self {
                    $(Self::$choice => $word,)+
                }
            }

            /// Returns the choice that a word stands for.
            pub fn from_word(word: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|choice| choice.word() == word)
            }

            /// Lists the words of all choices for people.
            pub fn words() -> String {
                $crate::either(&Self::ALL.map(Self::word))
            }
        }
    };
}

/// Words as a list for people: `a, b or c`.
///
/// ```
/// assert_eq!(base::either(&["m", "cm", "mm"]), "m, cm or mm");
/// assert_eq!(base::either(&["m"]), "m");
/// ```
pub fn either(words: &[&str]) -> String {
    match words {
        [most @ .., last] if !most.is_empty() => format!("{} or {last}", most.join(", ")),
        _ => words.concat(),
    }
}
