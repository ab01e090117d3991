with Ada.Containers.Vectors;

package Skein.Sequences.Short_Integers is new Ada.Containers.Vectors (Positive, Short_Integer);
