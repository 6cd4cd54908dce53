// SPDX-License-Identifier: Apache-2.0
#include "server/api/catalog_service.h"

#include <grpcpp/grpcpp.h>

namespace skinframe::server {

grpc::ServerUnaryReactor* CatalogService::ListPrinters(grpc::CallbackServerContext* context,
                                                       const v1::ListPrintersRequest*,
                                                       v1::ListPrintersResponse* response) {
  const auto catalog = catalog_.current();
  for (const v1::PrinterProfile& printer : catalog->printers()) *response->add_printers() = printer;
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  reactor->Finish(grpc::Status::OK);
  return reactor;
}

grpc::ServerUnaryReactor* CatalogService::ListMaterials(grpc::CallbackServerContext* context,
                                                        const v1::ListMaterialsRequest*,
                                                        v1::ListMaterialsResponse* response) {
  const auto catalog = catalog_.current();
  for (const v1::MaterialProfile& material : catalog->materials()) *response->add_materials() = material;
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  reactor->Finish(grpc::Status::OK);
  return reactor;
}

}  // namespace skinframe::server
