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

// Copies the depths of the framebuffer that is read from into another, and reads from that until it
// is destroyed. Several samples of a pixel become one, or pixels become fewer; OpenGL does not do
// both at once.
class CopiedDepths
{
public:
  CopiedDepths(const std::int32_t from[4], const std::int32_t size[2])
  {
    bool stencil = false;
    const GLenum format = DepthFormat(stencil);
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &this->Drawn);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &this->Read);
    glGenRenderbuffers(1, &this->Depths);
    glBindRenderbuffer(GL_RENDERBUFFER, this->Depths);
    glRenderbufferStorage(GL_RENDERBUFFER, format, from[2] + size[0], from[3] + size[1]);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    glGenFramebuffers(1, &this->Framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, this->Framebuffer);
    glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER,
      stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, this->Depths);
    const GLint left = from[2], bottom = from[3];
    glBlitFramebuffer(left, bottom, left + from[0], bottom + from[1], left, bottom, left + size[0],
      bottom + size[1], GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, this->Framebuffer);
  }
  ~CopiedDepths()
  {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(this->Drawn));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(this->Read));
    glDeleteFramebuffers(1, &this->Framebuffer);
    glDeleteRenderbuffers(1, &this->Depths);
  }
  CopiedDepths(const CopiedDepths&) = delete;
  void operator=(const CopiedDepths&) = delete;

private:
  GLint Drawn = 0, Read = 0;
  GLuint Framebuffer = 0, Depths = 0;
};
}

void CaptureDepths(const DepthPlace& place, GLuint buffer, std::int64_t offset)
{
  GLint drawn = 0, read = 0, samples = 0, alignment = 0;
  glGetIntegerv(GL_PACK_ALIGNMENT, &alignment);
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &drawn);
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(drawn));
  glGetIntegerv(GL_SAMPLES, &samples);
  {
    const std::int32_t* window = place.Window;
    const bool reduced = place.Size[0] != window[0] || place.Size[1] != window[1];
    const std::unique_ptr<CopiedDepths> resolved(
      samples > 0 ? new CopiedDepths(window, window) : nullptr);
    const std::unique_ptr<CopiedDepths> fewer(
      reduced ? new CopiedDepths(window, place.Size) : nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(window[2] + place.Part[2], window[3] + place.Part[3], place.Part[0], place.Part[1],
      GL_DEPTH_COMPONENT, GL_FLOAT,
      reinterpret_cast<void*>( // NOLINT(performance-no-int-to-ptr): an offset into the buffer
        static_cast<std::intptr_t>(offset)));
    glPixelStorei(GL_PACK_ALIGNMENT, alignment);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read));
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}
