with Ada.Containers.Vectors;

package Skein.Sequences.Integers is new Ada.Containers.Vectors (Positive, Integer);
