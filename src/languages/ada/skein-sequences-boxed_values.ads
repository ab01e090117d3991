with Ada.Containers.Vectors;

package Skein.Sequences.Boxed_Values is new Ada.Containers.Vectors (Positive, Box, Boxes."=");
