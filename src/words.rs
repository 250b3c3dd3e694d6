//! Enums whose variants have a word each, the same in JSON, in tables and on the command line.

/// An enum and the word of each variant, from one table: serde reads and writes the word, `word` and `Display` give it.
macro_rules! words {
    (
        $(#[$of_type:meta])*
        $visibility:vis enum $name:ident {
            $($(#[$of_variant:meta])* $variant:ident = $word:literal,)+
        }
    ) => {
        $(#[$of_type])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
        $visibility enum $name {
            $($(#[$of_variant])* #[serde(rename = $word)] $variant,)+
        }

        impl $name {
            /// The word of the document.
            #[must_use]
            $visibility const fn word(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)+
                }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.word())
            }
        }
    };
}

pub(crate) use words;

#[cfg(test)]
mod tests {
    words! {
        /// Two things.
        pub(crate) enum Thing {
            /// One.
            First = "first",
            /// The other, and a sign.
            Second = "second+more",
        }
    }

    #[test]
    fn a_word_is_written_and_read_back() {
        for thing in [Thing::First, Thing::Second] {
            let json = serde_json::to_string(&thing).unwrap();
            assert_eq!(json, format!("\"{thing}\""));
            assert_eq!(serde_json::from_str::<Thing>(&json).unwrap(), thing);
        }
        assert!(serde_json::from_str::<Thing>("\"third\"").is_err());
        assert_eq!(format!("{:>7}", Thing::First), "  first");
    }
}
