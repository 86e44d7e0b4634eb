// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GL/DepthCapture.h"

#include <memory>

namespace
{
// The internal format of the depths in the framebuffer that is read from.
GLenum DepthFormat(bool& stencil)
{
  GLint bits = 0, type = 0, stencilBits = 0, bound = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &bound);
  const GLenum depth = bound ? GL_DEPTH_ATTACHMENT : GL_DEPTH; // the window's own names it so
  const auto ask = [depth](GLenum what, GLint& answer)
  { glGetFramebufferAttachmentParameteriv(GL_READ_FRAMEBUFFER, depth, what, &answer); };
  ask(GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE, bits);
  ask(GL_FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE, stencilBits);
  ask(GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE, type);
  stencil = stencilBits > 0;
  if (type == GL_FLOAT)
  {
    return stencil ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F;
  }
  return stencil ? GL_DEPTH24_STENCIL8
    : bits == 16 ? GL_DEPTH_COMPONENT16
    : bits == 24 ? GL_DEPTH_COMPONENT24
                 : GL_DEPTH_COMPONENT32;
}

// Copies the depths of a multisampled framebuffer into one with a single sample a pixel, and reads
// from that until it is destroyed.
class ResolvedDepths
{
public:
  explicit ResolvedDepths(const std::int32_t part[4])
  {
    bool stencil = false;
    const GLenum format = DepthFormat(stencil);
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &this->Drawn);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &this->Read);
    glGenRenderbuffers(1, &this->Depths);
    glBindRenderbuffer(GL_RENDERBUFFER, this->Depths);
    glRenderbufferStorage(GL_RENDERBUFFER, format, part[2] + part[0], part[3] + part[1]);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    glGenFramebuffers(1, &this->Framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, this->Framebuffer);
    glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER,
      stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, this->Depths);
    const GLint left = part[2], bottom = part[3], right = left + part[0], top = bottom + part[1];
    glBlitFramebuffer(
      left, bottom, right, top, left, bottom, right, top, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, this->Framebuffer);
  }
  ~ResolvedDepths()
  {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(this->Drawn));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(this->Read));
    glDeleteFramebuffers(1, &this->Framebuffer);
    glDeleteRenderbuffers(1, &this->Depths);
  }
  ResolvedDepths(const ResolvedDepths&) = delete;
  void operator=(const ResolvedDepths&) = delete;

private:
  GLint Drawn = 0, Read = 0;
  GLuint Framebuffer = 0, Depths = 0;
};
}

void CaptureDepths(const std::int32_t part[4], GLuint buffer, std::int64_t offset)
{
  GLint drawn = 0, read = 0, samples = 0, alignment = 0;
  glGetIntegerv(GL_PACK_ALIGNMENT, &alignment);
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &drawn);
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(drawn));
  glGetIntegerv(GL_SAMPLES, &samples);
  {
    const std::unique_ptr<ResolvedDepths> resolved(
      samples > 0 ? new ResolvedDepths(part) : nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(part[2], part[3], part[0], part[1], GL_DEPTH_COMPONENT, GL_FLOAT,
      reinterpret_cast<void*>( // NOLINT(performance-no-int-to-ptr): an offset into the buffer
        static_cast<std::intptr_t>(offset)));
    glPixelStorei(GL_PACK_ALIGNMENT, alignment);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read));
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}
