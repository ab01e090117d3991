with Ada.Containers.Vectors;

package Skein.Sequences.Short_Short_Integers is new Ada.Containers.Vectors (Positive, Short_Short_Integer);
