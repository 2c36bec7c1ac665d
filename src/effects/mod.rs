//! Candidate effects: one file each, physical extensions of the base model that are off by default.
//!
//! To add an effect: write its file (parameters, law, table) and add its line to [`effects!`].

use crate::params::ParamSpec;

/// Registers effects: a field of [`Effects`] and a parameter table each.
macro_rules! effects {
    ($($name:ident :: $type:ident),* $(,)?) => {
        $(pub mod $name;)*
        /// Parameters of all effects.
        #[derive(Clone, Debug, PartialEq, Default)]
        pub struct Effects {
            $(
                #[doc = concat!("See [`", stringify!($name), "`].")]
                pub $name: $name::$type,
            )*
        }
        /// Names of all effects, in the order of registration.
        pub const NAMES: &[&str] = &[$(stringify!($name)),*];
        /// Parameter tables of all effects, in the order of registration.
        pub fn tables() -> Vec<&'static [ParamSpec]> {
            vec![$($name::PARAMS),*]
        }
    };
}

effects! {}
