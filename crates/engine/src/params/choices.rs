//! Parameters with a fixed set of text values.

/// Declares an enum for a parameter with a fixed set of text values.
///
/// ```
/// opendr_engine::choices! {
///     /// Method of non-maximum suppression.
///     pub enum Suppression {
///         /// Overlapping boxes of lower scores are removed.
///         Hard = "hard",
///         /// Their scores are lowered.
///         Soft = "soft",
///     }
/// }
/// assert_eq!(Suppression::default().name(), "hard");
/// ```
///
/// The first variant is the default.
#[macro_export]
macro_rules! choices {
    (
        $(#[$doc:meta])* $vis:vis enum $name:ident {
            $(#[$first_doc:meta])* $first:ident = $first_word:literal
            $(, $(#[$variant_doc:meta])* $variant:ident = $word:literal)* $(,)?
        }
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
        $vis enum $name {
            $(#[$first_doc])* #[default] $first,
            $($(#[$variant_doc])* $variant,)*
        }

        impl $name {
            /// Returns the text of the value, the same on every surface.
            pub const fn name(self) -> &'static str {
                match self { Self::$first => $first_word, $(Self::$variant => $word,)* }
            }
        }

        impl $crate::params::Param for $name {
            const KIND: $crate::params::ParamKind = $crate::params::ParamKind::Text;
            const CHOICES: &'static [&'static str] = &[$first_word $(, $word)*];

            fn from_value(value: &$crate::params::ParamValue) -> Option<Self> {
                let $crate::params::ParamValue::Text(word) = value else { return None };
                match word.as_str() {
                    $first_word => Some(Self::$first),
                    $($word => Some(Self::$variant),)*
                    _ => None,
                }
            }

            fn to_value(&self) -> $crate::params::ParamValue {
                $crate::params::ParamValue::Text(self.name().to_owned())
            }
        }
    };
}
