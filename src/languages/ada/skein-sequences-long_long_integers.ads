with Ada.Containers.Vectors;

package Skein.Sequences.Long_Long_Integers is new Ada.Containers.Vectors (Positive, Long_Long_Integer);
