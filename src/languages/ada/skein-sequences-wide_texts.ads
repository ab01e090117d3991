with Ada.Containers.Vectors;
with Ada.Strings.Wide_Unbounded;

package Skein.Sequences.Wide_Texts is new Ada.Containers.Vectors (Positive, Ada.Strings.Wide_Unbounded.Unbounded_Wide_String, Ada.Strings.Wide_Unbounded."=");
