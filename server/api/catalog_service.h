// SPDX-License-Identifier: Apache-2.0
// skinframe.v1.CatalogService. The catalog is in memory and never changes: answered on the spot.
#pragma once

#include "server/catalog/catalog.h"
#include "skinframe/v1/catalog.grpc.pb.h"

namespace skinframe::server {

class CatalogService final : public v1::CatalogService::CallbackService {
 public:
  explicit CatalogService(const Catalog& catalog) : catalog_(catalog) {}

  grpc::ServerUnaryReactor* ListPrinters(grpc::CallbackServerContext* context,
                                         const v1::ListPrintersRequest* request,
                                         v1::ListPrintersResponse* response) override;
  grpc::ServerUnaryReactor* ListMaterials(grpc::CallbackServerContext* context,
                                          const v1::ListMaterialsRequest* request,
                                          v1::ListMaterialsResponse* response) override;

 private:
  const Catalog& catalog_;
};

}  // namespace skinframe::server
