//! One definition of an input, and of a source of a device, in Rust and in TypeScript.

/// Declares a choice of records: the enum, the code that reads and writes its fields, and its type in TypeScript.
/// The field with the name after `by` selects the record.
macro_rules! choice {
    ($(#[doc = $about:literal])* $type:ident by $tag:literal {
        $($(#[doc = $doc:literal])* $op:literal $name:ident {
            $($(#[doc = $what:literal])* $key:literal $field:ident: $kind:ty,)*
        })*
    }) => {
        $(#[doc = $about])*
        #[derive(Clone, PartialEq, Debug)]
        #[allow(missing_docs)] // the fields are what the record says
        pub enum $type {
            $($(#[doc = $doc])* $name { $($(#[doc = $what])* $field: $kind),* },)*
        }

        impl $type {
            /// The declaration in TypeScript, in parts.
            pub const DECLARATION: &[&str] = &[
                concat!("/**" $(, $about)*, " */\nexport type ", stringify!($type), " ="),
                $(
                    concat!("\n  /**" $(, $doc)*, " */\n  | { ", $tag, ": '", $op, "'"),
                    $(
                        concat!("; ", $key),
                        <$kind as $crate::journal::field::Declared>::MARK,
                        ": ",
                        <$kind as $crate::journal::field::Declared>::TYPE,
                    )*
                    " }",
                )*
                ";\n",
            ];

            /// The record with this name and empty fields.
            fn named(name: &str) -> Option<Self> {
                Some(match name {
                    $($op => Self::$name { $($field: Default::default()),* },)*
                    _ => return None,
                })
            }

            fn fields(
                &mut self,
                visit: &mut dyn FnMut(&str, $crate::journal::field::Field<'_>),
            ) -> &'static str {
                match self {
                    $(Self::$name { $($field),* } => {
                        $(visit($key, $field.into());)*
                        $op
                    })*
                }
            }

            /// Reads the record with this name.
            ///
            /// # Errors
            /// Reason why it cannot be read.
            pub fn read(
                name: &str,
                from: &dyn $crate::journal::field::Fields,
            ) -> Result<Self, $crate::journal::field::Error> {
                let mut record = Self::named(name).ok_or($crate::journal::field::Error::Newer)?;
                let mut result = Ok(());
                record.fields(&mut |key, field| {
                    if result.is_ok() {
                        result = field.read(from, key);
                    }
                });
                result.map(|()| record)
            }

            /// Writes the record with its name.
            pub fn write(mut self, to: &mut dyn $crate::journal::field::Sink) {
                let name = self.fields(&mut |key, field| field.write(to, key));
                to.put($tag, $crate::journal::field::Value::Text(name.into()));
            }
        }
    };
}
pub(super) use choice;
