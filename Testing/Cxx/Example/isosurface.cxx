// Renders the isosurface of a generated field to a PNG: compress, hand over, render.
//   isosurface [output.png]
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkContourValues.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkImageZFPCompress.h>
#include <vtkIsosurfaceVolume.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkProgressiveIsosurfaceMapper.h>
#include <vtkProgressiveIsosurfaceStatistics.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkVolumeProperty.h>
#include <vtkWindowToImageFilter.h>

#include <cmath>
#include <iostream>

namespace
{
// Three periods of Schoen's gyroid along every axis.
void Gyroid(vtkImageData* image, int size)
{
  image->SetDimensions(size, size, size);
  vtkNew<vtkFloatArray> values;
  values->SetName("gyroid");
  values->SetNumberOfTuples(image->GetNumberOfPoints());
  const double step = 6.0 * std::acos(-1.0) / (size - 1);
  vtkIdType id = 0;
  for (int k = 0; k < size; ++k)
  {
    for (int j = 0; j < size; ++j)
    {
      for (int i = 0; i < size; ++i, ++id)
      {
        const double x = i * step;
        const double y = j * step;
        const double z = k * step;
        values->SetValue(id,
          static_cast<float>(
            std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x)));
      }
    }
  }
  image->GetPointData()->SetScalars(values);
}
}

int main(int argc, char* argv[])
{
  vtkNew<vtkImageData> field;
  Gyroid(field, 96);

  // 8 bits a voxel; the mapper takes the plain image as well, and compresses it itself
  vtkNew<vtkImageZFPCompress> compress;
  compress->SetInputData(field);
  compress->SetRate(8);

  vtkNew<vtkProgressiveIsosurfaceMapper> mapper;
  mapper->SetInputConnection(compress->GetOutputPort());

  // isovalue, colour and shading are those of any VTK volume
  vtkNew<vtkColorTransferFunction> colour;
  colour->AddRGBPoint(0.0, 0.93, 0.82, 0.62);
  vtkNew<vtkVolumeProperty> property;
  property->GetIsoSurfaceValues()->SetValue(0, 0.0);
  property->SetColor(colour);
  property->ShadeOn();

  vtkNew<vtkIsosurfaceVolume> isosurface;
  isosurface->SetMapper(mapper);
  isosurface->SetProperty(property);

  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(0.1, 0.12, 0.16);
  renderer->AddVolume(isosurface);
  renderer->GetActiveCamera()->SetPosition(3.0, 2.0, 4.0);
  renderer->ResetCamera();

  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(true); // off-screen renders always converge
  window->SetSize(640, 480);
  window->AddRenderer(renderer);
  window->Render();

  vtkNew<vtkWindowToImageFilter> picture;
  picture->SetInput(window);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(picture->GetOutputPort());
  writer->SetFileName(argc > 1 ? argv[1] : "isosurface.png");
  writer->Write();

  std::cout << writer->GetFileName() << ": "
            << (mapper->GetConverged() ? "converged after " : "did not converge in ")
            << mapper->GetStatistics()->GetNumberOfPasses() << " passes" << std::endl;
  return mapper->GetConverged() && writer->GetErrorCode() == 0 ? 0 : 1;
}
