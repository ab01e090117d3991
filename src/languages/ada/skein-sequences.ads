--  Sequences of what IDL has itself, a unit each, so that a program has only those that it uses. Sequences of a declared type lie
--  beside the first use of one.
package Skein.Sequences is
end Skein.Sequences;
