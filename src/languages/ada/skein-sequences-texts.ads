with Ada.Containers.Vectors;
with Ada.Strings.Unbounded;

package Skein.Sequences.Texts is new Ada.Containers.Vectors (Positive, Ada.Strings.Unbounded.Unbounded_String, Ada.Strings.Unbounded."=");
