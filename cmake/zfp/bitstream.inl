/* SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
** SPDX-License-Identifier: BSD-3-Clause
**
** zfp's bit stream: the implementation behind zfp/bitstream.h, which zfpy's source distribution leaves
** out (it packs *.c and *.h only). zfp's codec includes it for the sake of inlining. Our own, with the
** behaviour that the header and zfp's manual describe; a zfp source tree that has the file uses its own.
**
** Bits are stored in 64-bit words, first bit lowest. The word being read or written is buffered:
**   reading: the next `bits` bits of the stream are the low bits of `buffer`, the others are 0;
**   writing: the last `bits` bits written are the low bits of `buffer`, the others are 0;
** and 0 <= bits < 64 between calls. No bounds are checked: callers provide whole words.
*/
#include <stdlib.h>

#ifndef inline_
  #define inline_
#endif

#include "zfp/bitstream.h"

typedef uint64 bitstream_word;

#define wsize ((bitstream_count)64)

struct bitstream {
  bitstream_count bits;  /* number of buffered bits */
  bitstream_word buffer; /* buffered bits */
  bitstream_word* ptr;   /* next word in memory */
  bitstream_word* begin; /* first word in memory */
  bitstream_word* end;   /* one past the last word in memory */
};

/* the n lowest bits, 0 <= n < 64 */
static bitstream_word
stream_low_bits(bitstream_word value, bitstream_count n)
{
  return value & (((bitstream_word)1 << n) - 1);
}

/* construction ------------------------------------------------------------ */

inline_ void
stream_rewind(bitstream* s)
{
  s->bits = 0;
  s->buffer = 0;
  s->ptr = s->begin;
}

inline_ bitstream*
stream_open(void* buffer, size_t bytes)
{
  bitstream* s = (bitstream*)malloc(sizeof(bitstream));
  if (s) {
    s->begin = (bitstream_word*)buffer;
    s->end = s->begin + bytes / sizeof(bitstream_word);
    stream_rewind(s);
  }
  return s;
}

inline_ void
stream_close(bitstream* s)
{
  free(s);
}

inline_ bitstream*
stream_clone(const bitstream* s)
{
  bitstream* copy = (bitstream*)malloc(sizeof(bitstream));
  if (copy)
    *copy = *s;
  return copy;
}

/* inspection -------------------------------------------------------------- */

inline_ bitstream_count
stream_alignment(void)
{
  return wsize;
}

inline_ void*
stream_data(const bitstream* s)
{
  return s->begin;
}

inline_ size_t
stream_size(const bitstream* s)
{
  return (size_t)(s->ptr - s->begin) * sizeof(bitstream_word);
}

inline_ size_t
stream_capacity(const bitstream* s)
{
  return (size_t)(s->end - s->begin) * sizeof(bitstream_word);
}

/* strided streams are a build option of zfp that is off here */
inline_ size_t
stream_stride_block(const bitstream* s)
{
  (void)s;
  return 1;
}

inline_ ptrdiff_t
stream_stride_delta(const bitstream* s)
{
  (void)s;
  return 0;
}

inline_ bitstream_offset
stream_rtell(const bitstream* s)
{
  return (bitstream_offset)(s->ptr - s->begin) * wsize - s->bits;
}

inline_ bitstream_offset
stream_wtell(const bitstream* s)
{
  return (bitstream_offset)(s->ptr - s->begin) * wsize + s->bits;
}

/* reading ----------------------------------------------------------------- */

inline_ uint
stream_read_bit(bitstream* s)
{
  uint bit;
  if (s->bits == 0) {
    s->buffer = *s->ptr++;
    s->bits = wsize;
  }
  bit = (uint)(s->buffer & 1);
  s->buffer >>= 1;
  s->bits--;
  return bit;
}

inline_ uint64
stream_read_bits(bitstream* s, bitstream_count n)
{
  uint64 value = s->buffer;
  if (n <= s->bits) {
    /* n < 64: all bits are buffered */
    s->buffer >>= n;
    s->bits -= n;
    return stream_low_bits(value, n);
  }
  else {
    /* the buffer holds the `bits` low ones, the next word the others */
    bitstream_word word = *s->ptr++;
    bitstream_count used = n - s->bits; /* 1 <= used <= 64 */
    value |= word << s->bits;
    s->bits = wsize - used;
    s->buffer = s->bits ? word >> used : 0;
    return n < wsize ? stream_low_bits(value, n) : value;
  }
}

inline_ void
stream_rseek(bitstream* s, bitstream_offset offset)
{
  bitstream_count skip = (bitstream_count)(offset % wsize);
  s->ptr = s->begin + (size_t)(offset / wsize);
  s->buffer = skip ? *s->ptr++ >> skip : 0;
  s->bits = skip ? wsize - skip : 0;
}

inline_ void
stream_skip(bitstream* s, bitstream_size n)
{
  stream_rseek(s, stream_rtell(s) + n);
}

/* to the next word; returns the number of bits skipped */
inline_ bitstream_count
stream_align(bitstream* s)
{
  bitstream_count skipped = s->bits;
  s->buffer = 0;
  s->bits = 0;
  return skipped;
}

/* writing ----------------------------------------------------------------- */

inline_ uint
stream_write_bit(bitstream* s, uint bit)
{
  s->buffer |= (bitstream_word)bit << s->bits;
  s->bits++;
  if (s->bits == wsize) {
    *s->ptr++ = s->buffer;
    s->buffer = 0;
    s->bits = 0;
  }
  return bit;
}

/* writes the n low bits of value, 0 <= n <= 64, and returns its other bits */
inline_ uint64
stream_write_bits(bitstream* s, uint64 value, bitstream_count n)
{
  bitstream_count free_bits = wsize - s->bits; /* 1 <= free_bits <= 64 */
  bitstream_word rest = n < wsize ? value >> n : 0;
  bitstream_word low = n < wsize ? stream_low_bits(value, n) : value;
  s->buffer |= low << s->bits;
  if (n < free_bits)
    s->bits += n;
  else {
    /* the word is full: what did not fit starts the next one */
    *s->ptr++ = s->buffer;
    s->buffer = free_bits < wsize ? low >> free_bits : 0;
    s->bits = n - free_bits;
  }
  return rest;
}

inline_ void
stream_wseek(bitstream* s, bitstream_offset offset)
{
  s->ptr = s->begin + (size_t)(offset / wsize);
  s->bits = (bitstream_count)(offset % wsize);
  s->buffer = s->bits ? stream_low_bits(*s->ptr, s->bits) : 0;
}

/* appends n zero bits */
inline_ void
stream_pad(bitstream* s, bitstream_size n)
{
  bitstream_size bits = s->bits + n;
  for (; bits >= wsize; bits -= wsize) {
    *s->ptr++ = s->buffer;
    s->buffer = 0;
  }
  s->bits = (bitstream_count)bits;
}

/* pads with zero bits to a whole word; returns their number */
inline_ bitstream_count
stream_flush(bitstream* s)
{
  bitstream_count padding = (wsize - s->bits) % wsize;
  stream_pad(s, padding);
  return padding;
}

/* both ways --------------------------------------------------------------- */

inline_ void
stream_copy(bitstream* dst, bitstream* src, bitstream_size n)
{
  for (; n > wsize; n -= wsize)
    stream_write_bits(dst, stream_read_bits(src, wsize), wsize);
  stream_write_bits(dst, stream_read_bits(src, (bitstream_count)n), (bitstream_count)n);
}
